// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat {

extern const char* const kIndexPage;  ///< index_page.html; "@DATA@" is where its data go

}  // namespace sketchsplat
