// Peak memory of this program.
#pragma once

namespace rilo::cli {

/// Peak resident memory in MiB since the program began, or since restart_peak_rss().
double peak_rss_mb();

/// Lets the peak count from now on, with what earlier work left free given back to the system; a system that cannot do
/// so goes on with the old peak.
void restart_peak_rss();

}  // namespace rilo::cli
