// SPDX-License-Identifier: MIT
// In: results as JSON and pictures. Out: pages of HTML and pictures with curves drawn over them.
// This folder may not include anything else of pipelines.
#pragma once

#include <string>

namespace sketchsplat {

// Pages that need nothing but themselves. The texts are made from *_page.html, page.css, page.js
// and solid.js.

extern const char* const kReportPage;
extern const char* const kInspectionPage;
extern const char* const kLotPage;
extern const char* const kIndexPage;

/// The page with JSON in its data element; no text in it can end the element.
std::string fill_page(const std::string& page, const std::string& json);

/// JSON whose texts cannot end a script element.
std::string without_tags(const std::string& json);

std::string base64(const std::string& bytes);

}  // namespace sketchsplat
