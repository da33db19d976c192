#include "engine/scene/scene_json_transform.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

glm::dmat4 read_translate(const JsonReader& reader, const JsonValue& value) {
    const JsonObject step(reader, value, "translate step", {"translate"});
    return glm::translate(glm::dmat4(1), step.vector("translate", {}));
}

glm::dmat4 read_scale(const JsonReader& reader, const JsonValue& value) {
    const JsonObject step(reader, value, "scale step", {"scale"});
    const JsonValue& factor = step.at("scale");
    const glm::dvec3 scale = reader.is_number(factor) ? glm::dvec3(reader.number(factor, "scale"))
                                                      : reader.vector(factor, "scale");
    return glm::scale(glm::dmat4(1), scale);
}

glm::dmat4 read_rotate(const JsonReader& reader, const JsonValue& value) {
    const JsonObject step(reader, value, "rotate step", {"rotate", "axis"});
    const double degrees = step.number("rotate", 0);
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), step.direction("axis", {}));
}

glm::dmat4 read_look_at(const JsonReader& reader, const JsonValue& value) {
    const JsonObject step(reader, value, "look_at step", {"look_at", "from"}, {"up"});
    const glm::dvec3 from = step.vector("from", {});
    const glm::dvec3 way = step.vector("look_at", {}) - from;
    if (glm::length(way) < min_length) {
        reader.fail(step.at("look_at"), "'look_at' and 'from' are the same point; move one of them");
    }
    const glm::dvec3 up = glm::normalize(step.direction("up", {0, 1, 0}));
    const glm::dvec3 z = glm::normalize(way);
    if (glm::length(glm::cross(up, z)) < 1e-9) {
        const JsonValue* written = step.find("up");
        reader.fail(written == nullptr ? value : *written,
                    "'up' is parallel to the way from 'from' to 'look_at'; give it another direction");
    }
    const glm::dvec3 x = glm::normalize(glm::cross(up, z));
    const glm::dvec3 y = glm::cross(z, x);
    return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(from, 1)};
}

glm::dmat4 read_matrix(const JsonReader& reader, const JsonValue& value) {
    const JsonObject step(reader, value, "matrix step", {"matrix"});
    const JsonValue& matrix = step.at("matrix");
    constexpr std::string_view form = "4 rows of 4 numbers";
    const std::span<const JsonValue> rows = reader.array(matrix, "matrix", form);
    if (rows.size() != 4) reader.fail_type(matrix, "matrix", form);
    glm::dmat4 m;
    for (int row = 0; row < 4; ++row) {
        std::array<double, 4> numbers{};
        reader.numbers(rows[static_cast<std::size_t>(row)], "matrix", "a row of 4 numbers", numbers);
        for (int column = 0; column < 4; ++column) m[column][row] = numbers[static_cast<std::size_t>(column)];
    }
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) {
        reader.fail(rows[3], "the last row of the matrix must be 0 0 0 1");
    }
    return m;
}

glm::dmat4 read_step(const JsonReader& reader, const JsonValue& value) {
    struct Step {
        std::string_view name;
        glm::dmat4 (*read)(const JsonReader&, const JsonValue&);
    };
    constexpr std::array<Step, 5> steps = {{{"translate", read_translate},
                                            {"scale", read_scale},
                                            {"rotate", read_rotate},
                                            {"look_at", read_look_at},
                                            {"matrix", read_matrix}}};
    const std::span<const JsonMember> members = reader.members(value, "step of a transform");
    const Step* found = nullptr;
    for (const JsonMember& member : members) {
        const auto* const step =
            std::find_if(steps.begin(), steps.end(), [&](const Step& s) { return s.name == member.key; });
        if (step == steps.end()) continue;
        if (found != nullptr) {
            throw SceneError(reader.document().place(member),
                             fmt::format("one operation a step: write [{{\"{}\": …}}, {{\"{}\": …}}]",
                                         found->name, step->name));
        }
        found = step;
    }
    if (found != nullptr) {
        const glm::dmat4 m = found->read(reader, value);
        if (found->name == "matrix") {
            check_transform(m, reader.place(value),
                            "the first three columns of its matrix must not lie in one plane");
        } else {
            check_transform(m, reader.place(value));
        }
        return m;
    }
    constexpr std::array<std::string_view, 5> names = {"translate", "scale", "rotate", "look_at", "matrix"};
    if (members.empty()) reader.fail(value, "this step is empty" + suggest("", "steps", names));
    throw SceneError(
        reader.document().place(members[0]),
        fmt::format("unknown step {}{}", in_quotes(members[0].key), suggest(members[0].key, "steps", names)));
}

}  // namespace

glm::dmat4 read_transform(const JsonReader& reader, const JsonValue& value) {
    if (value.kind == JsonKind::object) return read_step(reader, value);
    const std::span<const JsonValue> steps =
        reader.array(value, "transform", "a step, such as {\"translate\": [1, 0, 0]}, or an array of steps");
    glm::dmat4 m(1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const glm::dmat4 step = read_step(reader, steps[i]);
        m = i == 0 ? step : step * m;
    }
    if (steps.size() > 1) check_transform(m, reader.place(value));
    return m;
}

}  // namespace sahl
