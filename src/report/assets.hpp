// Style sheet and script of the report (assets/), compiled in.
#pragma once

namespace rilo {

extern const char* const kReportCss;
extern const char* const kReportJs;

}  // namespace rilo
