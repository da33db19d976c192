#include "cli/batch_order.h"

#include <nlohmann/json.hpp>

namespace nlohmann {

template <class T>
struct adl_serializer<std::optional<T>> {
    static void to_json(json& out, const std::optional<T>& value) {
        if (value) out = *value;
    }
    static void from_json(const json& in, std::optional<T>& value) {
        if (!in.is_null()) value = in.get<T>();
    }
};

template <>
struct adl_serializer<glm::dvec3> {
    static void to_json(json& out, const glm::dvec3& value) { out = {value.x, value.y, value.z}; }
    static void from_json(const json& in, glm::dvec3& value) { value = {in.at(0), in.at(1), in.at(2)}; }
};

/// Names of files may be no UTF-8; MessagePack does not mind.
template <>
struct adl_serializer<std::filesystem::path> {
    static void to_json(json& out, const std::filesystem::path& value) { out = value.string(); }
    static void from_json(const json& in, std::filesystem::path& value) { value = in.get<std::string>(); }
};

}  // namespace nlohmann

namespace sahl {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Resolution, width, height)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Camera, eye, look_at, up, fov_y, name)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ImageSettings, size, depth, spp, seed, build_quality, aovs, pixel_type,
                                   transfer, rounding, exposure, compression)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BatchJob, scene, asset_root, parameters, camera, view, frame, settings,
                                   outputs)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContentFile, name, path, bytes_hash, content_hash)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SceneContent, files, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceOptions, selector, threads, work_group_size, traversal,
                                   build_options, takes_compile_orders)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EngineIdentity, version, kernels)

}  // namespace sahl

namespace sahl::cli {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WorkerSettings, device, max_memory, checkpoint_seconds, force, engine,
                                   log_level)

namespace {

/// These do not compile when there is a member that is not listed above.
[[maybe_unused]] void all_members(const ImageSettings& i, const BatchJob& j, const Camera& c,
                                  const SceneContent& s, const DeviceOptions& d, const WorkerSettings& w) {
    [[maybe_unused]] const auto& [i1, i2, i3, i4, i5, i6, i7, i8, i9, i10, i11] = i;
    [[maybe_unused]] const auto& [j1, j2, j3, j4, j5, j6, j7, j8] = j;
    [[maybe_unused]] const auto& [c1, c2, c3, c4, c5] = c;
    [[maybe_unused]] const auto& [s1, s2] = s;
    [[maybe_unused]] const auto& [d1, d2, d3, d4, d5, d6] = d;
    [[maybe_unused]] const auto& [w1, w2, w3, w4, w5, w6] = w;
}

}  // namespace

nlohmann::json message_of(const WorkerSettings& settings) { return {{"settings", settings}}; }

WorkerSettings read_worker_settings(const nlohmann::json& message) {
    return message.at("settings").get<WorkerSettings>();
}

nlohmann::json message_of(std::size_t index, bool wait, const BatchJob& job, const SceneContent* content) {
    nlohmann::json message{{"job", index}, {"wait", wait}, {"what", job}};
    if (content != nullptr) message["content"] = *content;
    return message;
}

Order read_order(const nlohmann::json& message, const std::shared_ptr<const SceneContent>& last) {
    Order order{message.at("job"), message.at("wait"), message.at("what").get<BatchJob>(), last};
    if (message.contains("content"))
        order.content = std::make_shared<const SceneContent>(message.at("content").get<SceneContent>());
    return order;
}

}  // namespace sahl::cli
