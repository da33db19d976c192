// Vectors whose resize() leaves new elements as they are: for those that several threads write before anybody
// reads them. Clearing them first would be the work of one thread, which the system gives each page to.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace sahl {

template <class T>
struct UninitializedAllocator : std::allocator<T> {
    template <class Other>
    struct rebind {  // NOLINT(readability-identifier-naming): the standard's names
        using other = UninitializedAllocator<Other>;  // NOLINT(readability-identifier-naming)
    };

    template <class Element>
    void construct(Element* place) {
        ::new (static_cast<void*>(place)) Element;
    }
    template <class Element, class... Arguments>
    void construct(Element* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) Element(std::forward<Arguments>(arguments)...);
    }
};

template <class T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace sahl
