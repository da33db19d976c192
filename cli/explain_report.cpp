#include "cli/explain_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/render_settings.h"
#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 6> kind_names{"triangle", "polygon", "sphere", "cone", "disc", "box"};
constexpr std::array<const char*, 3> origin_names{"camera", "reflected", "transmitted"};
constexpr double one = 0x1p32;  ///< in the film's units

bool meets_nothing(const ExplainedRay& ray) { return ray.primitive == no_aov_id; }

const char* kind_of(const Scene& scene, const ExplainedRay& ray) {
    return kind_names[static_cast<std::size_t>(scene.primitives[ray.primitive].kind)];
}

const Material& material_of(const Scene& scene, const ExplainedRay& ray) {
    return scene.materials[scene.primitives[ray.primitive].material];
}

const char* origin_of(const ExplainedRay& ray) { return origin_names[static_cast<std::size_t>(ray.from)]; }

/// The sums of a generation.
struct Generation {
    std::uint64_t rays = 0;
    FixedColor fixed{};
};

std::vector<Generation> generations_of(const Explanation& explanation) {
    std::vector<Generation> generations;
    for (const ExplainedRay& ray : explanation.rays) {
        if (generations.size() <= ray.generation) generations.resize(ray.generation + std::size_t{1});
        Generation& generation = generations[ray.generation];
        ++generation.rays;
        for (std::size_t c = 0; c < ray.fixed.size(); ++c) generation.fixed[c] += ray.fixed[c];
    }
    return generations;
}

/// Rays by their parents, in the order in which a tree is printed; camera rays are parents of themselves.
std::vector<std::vector<std::uint32_t>> children_of(const Explanation& explanation) {
    std::vector<std::vector<std::uint32_t>> children(explanation.rays.size());
    for (std::uint32_t i = 0; i < explanation.rays.size(); ++i) {
        const std::uint32_t parent = explanation.rays[i].parent;
        if (parent != i) children[parent].push_back(i);
    }
    return children;
}

std::string color_text(const glm::vec3& color) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", color.x, color.y, color.z);
}

std::string color_text(const FixedColor& sum, double divisor = one) {
    return color_text(glm::vec3(static_cast<double>(sum[0]) / divisor, static_cast<double>(sum[1]) / divisor,
                                static_cast<double>(sum[2]) / divisor));
}

/// What became of a light: "lit", "blocked", "filtered" by transparent surfaces, "-" if it brings nothing.
const char* light_text(const ExplainedLight& light) {
    if (light.unshadowed == glm::vec3(0)) return "-";
    if (light.arriving == light.unshadowed) return "lit";
    return light.arriving == glm::vec3(0) ? "blocked" : "filtered";
}

std::string lights_text(const ExplainedRay& ray) {
    std::string text;
    for (const ExplainedLight& light : ray.lights) {
        text += fmt::format("{}{}", text.empty() ? "" : " ", light_text(light));
    }
    return text;
}

std::string target_text(const Scene& scene, const ExplainedRay& ray) {
    if (meets_nothing(ray)) return "nothing: background";
    const std::string& material = material_of(scene, ray).name;
    std::string text =
        fmt::format("{} {}, {}", kind_of(scene, ray), ray.primitive,
                    material.empty() ? fmt::format("material {}", scene.primitives[ray.primitive].material)
                                     : "'" + material + "'");
    if (ray.instance > 0) text += fmt::format(" in instance {}", ray.instance);
    return text;
}

std::string distance_text(const ExplainedRay& ray) {
    if (meets_nothing(ray)) return "";
    return fmt::format(
        "{:.4g}", ray.t * std::sqrt(ray.direction.x * ray.direction.x + ray.direction.y * ray.direction.y +
                                    ray.direction.z * ray.direction.z));
}

using Row = std::array<std::string, 6>;

/// A table with columns as wide as what is in them.
std::string table_text(const std::vector<Row>& rows) {
    std::array<std::size_t, std::tuple_size_v<Row>> widths{};
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    }
    return text;
}

void add_tree(std::vector<Row>& rows, const ExplainedPixel& pixel,
              const std::vector<std::vector<std::uint32_t>>& children, std::uint32_t i) {
    const ExplainedRay& ray = pixel.explanation.rays[i];
    rows.push_back({std::string(ray.generation, ' ') + origin_of(ray), target_text(pixel.scene, ray),
                    distance_text(ray), color_text(ray.weight), color_text(ray.contribution),
                    lights_text(ray)});
    for (const std::uint32_t child : children[i]) add_tree(rows, pixel, children, child);
}

}  // namespace

std::string explanation_text(const ExplainedPixel& pixel) {
    const Explanation& explanation = pixel.explanation;
    const RenderSettings& settings = pixel.settings;
    std::string text =
        fmt::format("pixel {},{} of {}, camera {}, {}x{}, depth {}, {} of {} samples\n\n", pixel.x, pixel.y,
                    pixel.options.scene, pixel.scene.cameras[settings.camera].name, settings.resolution.width,
                    settings.resolution.height, settings.depth, sample_count(settings), settings.spp);
    std::vector<Row> rows{{"ray", "meets", "at", "weight", "contribution", "lights"}};
    const auto children = children_of(explanation);
    for (std::uint32_t i = 0; i < explanation.rays.size(); ++i) {
        if (explanation.rays[i].parent == i) add_tree(rows, pixel, children, i);
    }
    text += table_text(rows);
    text += fmt::format("\n{:<12}{:>8}  {:<30}in units of 2^-32\n", "generation", "rays", "contribution");
    const auto sums = [&text](const std::string& name, std::uint64_t rays, const FixedColor& sum) {
        text +=
            fmt::format("{:<12}{:>8}  {:<30}{} {} {}\n", name, rays, color_text(sum), sum[0], sum[1], sum[2]);
    };
    const std::vector<Generation> generations = generations_of(explanation);
    for (std::size_t i = 0; i < generations.size(); ++i) {
        sums(std::to_string(i), generations[i].rays, generations[i].fixed);
    }
    sums("all", explanation.rays.size(), explanation.sum);
    text += fmt::format("the pixel's colour is the sum over {}: {}\n", sample_count(settings),
                        color_text(explanation.sum, one * sample_count(settings)));
    return text;
}

namespace {

Json vector_array(const glm::vec3& v) { return {v.x, v.y, v.z}; }

Json ray_object(const Scene& scene, const ExplainedRay& ray) {
    Json object{{"parent", ray.generation == 0 ? Json() : Json(ray.parent)},
                {"generation", ray.generation},
                {"sample", ray.sample},
                {"from", origin_of(ray)},
                {"origin", vector_array(ray.origin)},
                {"direction", vector_array(ray.direction)},
                {"weight", vector_array(ray.weight)},
                {"t", nullptr},
                {"primitive", nullptr}};
    if (!meets_nothing(ray)) {
        object["t"] = ray.t;
        object["primitive"] = ray.primitive;
        object["kind"] = kind_of(scene, ray);
        object["instance"] = ray.instance;
        object["material"] = scene.primitives[ray.primitive].material;
        object["material_name"] = material_of(scene, ray).name;
    }
    object["own"] = vector_array(ray.own);
    object["lights"] = Json::array();
    for (const ExplainedLight& light : ray.lights) {
        object["lights"].push_back(
            {{"unshadowed", vector_array(light.unshadowed)}, {"arriving", vector_array(light.arriving)}});
    }
    object["contribution"] = vector_array(ray.contribution);
    object["fixed"] = ray.fixed;
    return object;
}

}  // namespace

void print_explanation(const ExplainedPixel& pixel) {
    const Explanation& explanation = pixel.explanation;
    const RenderSettings& settings = pixel.settings;
    Json rays = Json::array();
    for (const ExplainedRay& ray : explanation.rays) rays.push_back(ray_object(pixel.scene, ray));
    Json generations = Json::array();
    for (const Generation& generation : generations_of(explanation)) {
        generations.push_back({{"rays", generation.rays}, {"fixed", generation.fixed}});
    }
    Json color = Json::array();
    for (const std::int64_t sum : explanation.sum) {
        color.push_back(static_cast<float>(static_cast<double>(sum) / (one * sample_count(settings))));
    }
    print_event({{"event", "explanation"},
                 {"scene", pixel.options.scene},
                 {"camera", pixel.scene.cameras[settings.camera].name},
                 {"width", settings.resolution.width},
                 {"height", settings.resolution.height},
                 {"depth", settings.depth},
                 {"spp", settings.spp},
                 {"samples", sample_count(settings)},
                 {"pixel", {pixel.x, pixel.y}},
                 {"rays", rays},
                 {"generations", generations},
                 {"fixed", explanation.sum},
                 {"color", color}});
}

}  // namespace sahl::cli
