#include "engine/core/background.h"

#include <sys/resource.h>
#include <unistd.h>

namespace sahl {

void run_in_background() {
    // Not the last place: then other programs could keep it waiting for as long as they run.
    constexpr int niceness = 10;
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);  // of one thread, on Linux
}

}  // namespace sahl
