// Memory that runs out at a chosen moment: this program's operator new.
#pragma once

#include <cstdint>

namespace sahl::tests {

/// While it lives, the `nth` allocation (from 1, of all threads) throws std::bad_alloc. One at a time.
class FailingNew {
public:
    explicit FailingNew(std::uint64_t nth);
    ~FailingNew();
    FailingNew(const FailingNew&) = delete;
    FailingNew& operator=(const FailingNew&) = delete;

    /// Whether there were as many allocations.
    bool has_failed() const;
};

}  // namespace sahl::tests
