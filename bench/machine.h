// What a report has to say of where it was measured.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace sahl::bench {

/// Processor, cores, caches, memory, system, and the versions of Sahl, Embree, the OpenCL driver and the
/// compiler.
nlohmann::ordered_json machine_facts();

/// Writes the report; an existing file is replaced. Throws Error(output) with the file's name.
void write_report(const nlohmann::ordered_json& report, const std::string& file);

}  // namespace sahl::bench
