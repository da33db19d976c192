// Documents against a JSON Schema of docs/.
#pragma once

#include <memory>
#include <string>

#include <nlohmann/json.hpp>

namespace sahl::tests {

/// A JSON Schema, draft 7.
class JsonSchema {
public:
    /// `name`: of a file in docs/. Throws when it is none.
    explicit JsonSchema(const std::string& name);
    ~JsonSchema();

    /// Why the document is refused; empty: it is valid.
    std::string refusal(const nlohmann::json& document) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sahl::tests
