// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat {

/// The text of report_page.html, compiled in; "@DATA@" stands where the JSON goes.
extern const char* const kReportPage;

}  // namespace sketchsplat
