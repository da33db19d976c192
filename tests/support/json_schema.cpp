#include "tests/support/json_schema.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace sahl::tests {

struct JsonSchema::Impl {
    valijson::Schema schema{};
};

JsonSchema::JsonSchema(const std::string& name) : impl_(std::make_unique<Impl>()) {
    std::ifstream file(std::filesystem::path(std::getenv("SAHL_SOURCE_DIR")) / "docs" / name);
    const nlohmann::json document = nlohmann::json::parse(file);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), impl_->schema);
}

JsonSchema::~JsonSchema() = default;

std::string JsonSchema::refusal(const nlohmann::json& document) const {
    valijson::Validator validator;
    valijson::ValidationResults results;
    if (validator.validate(impl_->schema, valijson::adapters::NlohmannJsonAdapter(document), &results))
        return "";
    std::string text;
    for (valijson::ValidationResults::Error error; results.popError(error);) {
        for (const std::string& context : error.context) text += context;
        text += ": " + error.description + "\n";
    }
    return text.empty() ? "refused" : text;
}

}  // namespace sahl::tests
