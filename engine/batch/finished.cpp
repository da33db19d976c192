#include "engine/batch/finished.h"

#include "engine/batch/image_record.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

StoredRecord read_folder_record(const fs::path& path, std::map<fs::path, FolderRecords>& folders) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (failed) return {{}, fs::exists(path) ? failed.message() : "it is not there"};
    FolderRecords& records = folders.try_emplace(path.parent_path(), path.parent_path()).first->second;
    const FolderRecords::Entry* entry = records.find(path.filename().string());
    if (entry == nullptr) return {};
    if (entry->size != size) return {{}, "its size is not what was written"};
    return {entry->record, {}};
}

}  // namespace

std::vector<BatchOutput> outputs_of(const BatchJob& job, const SceneContent& content,
                                    const EngineIdentity& engine) {
    const std::vector<OutputSettings> encodings = settings_for(job.outputs, encoding_of(job.settings));
    std::vector<BatchOutput> outputs;
    for (std::size_t i = 0; i < job.outputs.size(); ++i) {
        const bool wants_aovs = job.settings.aovs && !job.settings.aovs->empty();
        const bool has_aovs = wants_aovs && can_hold_aovs(job.outputs[i]);
        outputs.push_back({job.outputs[i], encodings[i], has_aovs,
                           make_record(job, encodings[i], has_aovs, content, engine)});
    }
    return outputs;
}

std::string reason_to_render(const BatchOutput& output, std::map<fs::path, FolderRecords>& folders) {
    const StoredRecord stored =
        keeps_record(output.path) ? read_image_record(output.path) : read_folder_record(output.path, folders);
    if (!stored.problem.empty()) return stored.problem;
    if (stored.record.empty()) return "it has no record of where it came from";
    if (hash_of_record(stored.record) == hash_of_record(output.record)) return "";
    return difference_of_records(stored.record, output.record);
}

}  // namespace sahl
