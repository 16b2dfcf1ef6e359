// SPDX-License-Identifier: MIT
#include "datasets/step/read_step_shape.h"

#include <BinTools.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>

#include "datasets/step/child_bytes.h"
#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

constexpr const char* kExpected = "a STEP file";
constexpr unsigned kSeconds = 2, kSecondsPerMb = 20;  // of CPU
constexpr char kShape = 'S', kRefused = 'R';          // first byte of what the child says

void check_beginning(const std::string& path) {
  std::ifstream file(path);
  check_length(&file, path);
  std::string magic(13, '\0');
  if (!file.read(&magic[0], 13))
    throw InputError(path, kExpected, file.is_open() ? "too few bytes" : "no readable file");
  if (magic != "ISO-10303-21;")
    throw InputError(path, "a STEP file (ISO-10303-21)", "another kind");
}

std::string refused(const std::string& why) { return kRefused + why; }

// In the child.
std::string shape_bytes(const std::string& path) {
  // The reader reports to the terminal, which is the caller's.
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  try {
    STEPControl_Reader reader;
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
      return refused("entities that cannot be read");
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.OneShape();
    if (shape.IsNull()) return refused("no shape");
    std::ostringstream out;
    out << kShape;
    BinTools::Write(shape, out);
    return out.str();
  } catch (const Standard_Failure& failure) {
    const char* message = failure.GetMessageString();
    return refused(message && *message ? message : "what Open CASCADE cannot read");
  }
}

unsigned seconds_for(const std::string& path) {
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  return kSeconds + (none ? 0 : unsigned(double(bytes) * 1e-6 * kSecondsPerMb));
}

}  // namespace

TopoDS_Shape read_step_shape(const std::string& path) {
  check_beginning(path);
  const unsigned seconds = seconds_for(path);
  const ChildBytes said = run_in_child([&] { return shape_bytes(path); }, seconds);
  if (said.signal == SIGXCPU || said.signal == SIGKILL)
    throw InputError(
        path, kExpected,
        "what Open CASCADE has not read after " + std::to_string(seconds) + " s of CPU");
  if (said.signal != 0)
    throw InputError(path, kExpected,
                     std::string("what Open CASCADE crashes on (") + strsignal(said.signal) + ")");
  if (said.exit_status == 2) throw std::bad_alloc();
  if (said.bytes.empty() || said.bytes[0] != kShape)
    throw InputError(path, kExpected,
                     said.bytes.empty() ? "what Open CASCADE cannot read" : said.bytes.substr(1));
  std::istringstream in(said.bytes.substr(1));
  TopoDS_Shape shape;
  BinTools::Read(shape, in);
  return shape;
}

}  // namespace sketchsplat
