// Work beside the work that somebody waits for.
#pragma once

namespace sahl {

/// From now on this thread mostly runs when others leave a processor free.
void run_in_background();

}  // namespace sahl
