// What the supervisor of a batch tells its worker, which is another program and knows nothing else.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "cli/batch_setup.h"

namespace sahl::cli {

/// {"settings": …}, the first message to a worker.
nlohmann::json message_of(const WorkerSettings& settings);
WorkerSettings read_worker_settings(const nlohmann::json& message);

/// A job to do.
struct Order {
    std::size_t index = 0;  ///< of the job, for answers
    bool wait = false;      ///< while another process has it, rather than give it back
    BatchJob job{};
    std::shared_ptr<const SceneContent> content{};
};

/// {"job": index, "wait", "what"} and, if `content` is no nullptr, "content": whoever reads it needs to be
/// told of a scene only once.
nlohmann::json message_of(std::size_t index, bool wait, const BatchJob& job, const SceneContent* content);
/// `last`: the content of the order before.
Order read_order(const nlohmann::json& message, const std::shared_ptr<const SceneContent>& last);

}  // namespace sahl::cli
