// What a finished image says about where it came from: by that a later run knows that it is finished.
#pragma once

#include <string>

#include "engine/batch/batch_job.h"
#include "engine/batch/scene_content.h"

namespace sahl {

/// The name of the record in the metadata of EXR and PNG files.
inline constexpr const char* record_name = "Sahl:Record";

/// Hash of the kernels and the engine's version: other ones may make other pixels.
struct EngineIdentity {
    std::string version;
    std::string kernels;
};
EngineIdentity engine_identity();

/// All that decides about the content of an output of `job`, as a line of JSON: engine, kernels, settings,
/// parameters, hashes of the scene's files, "hash" over all these, and "parts" for explanations.
/// `encoding` and `has_aovs`: of this output.
std::string make_record(const BatchJob& job, const OutputSettings& encoding, bool has_aovs,
                        const SceneContent& content, const EngineIdentity& engine);

/// The "hash" of a record; empty if it is none.
std::string hash_of_record(const std::string& record);

/// Why an image with the record `old` is not what `current` asks for, in words: "spp changed from 1 to 4",
/// "temple.json: materials.red.diffuse changed". Empty if it is.
std::string difference_of_records(const std::string& old, const std::string& current);

}  // namespace sahl
