// One answer of a kernel beside the reference's.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

namespace sahl::self_test {

/// The largest difference among the quantities compared for one ray.
class Difference {
public:
    /// Numbers differ relatively above 1 and absolutely below; a vector as its worst component does, not
    /// finite or missing numbers infinitely. `scale` multiplies the difference.
    void number(std::string_view what, double expected, double found, double scale = 1);
    void vector(std::string_view what, const glm::dvec3& expected, const glm::dvec3& found);
    /// Ids, counts and flags: equal or infinitely different.
    void exact(std::string_view what, std::uint64_t expected, std::uint64_t found);

    double amount() const { return amount_; }
    /// "WHAT: expected …, found …, difference …".
    std::string text() const;

private:
    enum class Kind { number, vector, exact };
    void offer(Kind kind, double amount, std::string_view what, const glm::dvec3& expected,
               const glm::dvec3& found);

    double amount_ = -1;  ///< nothing compared yet
    Kind kind_ = Kind::exact;
    std::string_view what_;
    glm::dvec3 expected_{0}, found_{0};  ///< of numbers the first component
};

}  // namespace sahl::self_test
