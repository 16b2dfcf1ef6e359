// SPDX-License-Identifier: MIT
#include "datasets/step/read_step_shape.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <filesystem>
#include <fstream>

#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

constexpr const char* kExpected = "a STEP file";

void check_beginning(const std::string& path) {
  std::ifstream file(path);
  check_length(&file, path);
  std::string magic(13, '\0');
  if (!file.read(&magic[0], 13))
    throw InputError(path, kExpected, file.is_open() ? "too few bytes" : "no readable file");
  if (magic != "ISO-10303-21;")
    throw InputError(path, "a STEP file (ISO-10303-21)", "another kind");
}

}  // namespace

TopoDS_Shape read_step_shape(const std::string& path) {
  check_beginning(path);
  // The reader reports to the terminal, which is the caller's.
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    throw InputError(path, kExpected, "entities that cannot be read");
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) throw InputError(path, "a shape with faces", "none");
  return shape;
}

unsigned seconds_to_read(const std::string& path) {
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  return 2 + (none ? 0 : unsigned(double(bytes) * 20e-6));
}

}  // namespace sketchsplat
