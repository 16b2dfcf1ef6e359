// SPDX-License-Identifier: MIT
#include "datasets/step/guarded.h"

#include <BinTools.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <csignal>
#include <cstring>
#include <new>
#include <sstream>

#include "datasets/step/child_bytes.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

// First byte of what the child says.
constexpr char kDone = 'D', kRefused = 'R', kInputError = 'I';

std::string said_by_child(const std::function<std::string()>& work) {
  try {
    return kDone + work();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const char* message = failure.GetMessageString();
    return std::string(1, kRefused) + (message ? message : "");
  } catch (const InputError& error) {
    return kInputError + std::string(error.what());
  }
}

std::string ended_by(int number, unsigned seconds) {
  if (number == SIGXCPU || number == SIGKILL)
    return "what Open CASCADE is not done with after " + std::to_string(seconds) + " s of CPU";
  return std::string("what Open CASCADE crashes on (") + strsignal(number) + ")";
}

}  // namespace

std::string guarded(const std::string& name, const std::string& expected, unsigned seconds,
                    const std::function<std::string()>& work) {
  const ChildBytes child = run_in_child([&] { return said_by_child(work); }, seconds);
  if (child.signal != 0) throw InputError(name, expected, ended_by(child.signal, seconds));
  if (child.exit_status == ChildBytes::kNoMemory) throw std::bad_alloc();
  const char kind = child.bytes.empty() ? kRefused : child.bytes[0];
  const std::string rest = child.bytes.empty() ? "" : child.bytes.substr(1);
  if (kind == kDone) return rest;
  if (kind == kInputError) throw InputError(rest);
  throw InputError(name, expected, rest.empty() ? "what Open CASCADE refuses" : rest);
}

std::string bytes_of(const TopoDS_Shape& shape) {
  std::ostringstream out;
  BinTools::Write(shape, out);
  return out.str();
}

TopoDS_Shape shape_of(const std::string& bytes) {
  std::istringstream in(bytes);
  TopoDS_Shape shape;
  BinTools::Read(shape, in);
  return shape;
}

}  // namespace sketchsplat
