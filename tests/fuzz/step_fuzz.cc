// SPDX-License-Identifier: MIT
// STEP files: what Open CASCADE makes of them in a child process, and faces and edges of that here.
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "datasets/step/child_bytes.h"
#include "datasets/step/read_step_shape.h"
#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/render/cad_part.h"
#include "tests/fuzz/fuzz.h"
#include "tests/topology/solids.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {
namespace {

// Half a disc: a whole file within the bytes that libFuzzer gives a target.
constexpr const char* kHalfDisc = R"(ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('','',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));
ENDSEC;
DATA;
#1=APPLICATION_CONTEXT('');
#2=PRODUCT_CONTEXT('',#1,'');
#3=PRODUCT('','','',(#2));
#4=PRODUCT_DEFINITION_FORMATION('','',#3);
#5=PRODUCT_DEFINITION_CONTEXT('',#1,'');
#6=PRODUCT_DEFINITION('','',#4,#5);
#7=PRODUCT_DEFINITION_SHAPE('','',#6);
#8=SHAPE_DEFINITION_REPRESENTATION(#7,#9);
#9=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#10),#40);
#10=SHELL_BASED_SURFACE_MODEL('',(#11));
#11=OPEN_SHELL('',(#12));
#12=ADVANCED_FACE('',(#13),#20,.T.);
#13=FACE_BOUND('',#14,.T.);
#14=EDGE_LOOP('',(#15,#16));
#15=ORIENTED_EDGE('',*,*,#17,.T.);
#16=ORIENTED_EDGE('',*,*,#18,.T.);
#17=EDGE_CURVE('',#30,#31,#19,.T.);
#18=EDGE_CURVE('',#31,#30,#21,.T.);
#19=LINE('',#34,#35);
#20=PLANE('',#22);
#21=CIRCLE('',#22,1.);
#22=AXIS2_PLACEMENT_3D('',#23,#24,#25);
#23=CARTESIAN_POINT('',(0.,0.,0.));
#24=DIRECTION('',(0.,0.,1.));
#25=DIRECTION('',(1.,0.,0.));
#30=VERTEX_POINT('',#34);
#31=VERTEX_POINT('',#33);
#33=CARTESIAN_POINT('',(1.,0.,0.));
#34=CARTESIAN_POINT('',(-1.,0.,0.));
#35=VECTOR('',#25,1.);
#40=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#41))
REPRESENTATION_CONTEXT('',''));
#41=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));
ENDSEC;
END-ISO-10303-21;
)";

}  // namespace

std::vector<std::string> fuzz_seeds() {
  const FuzzFolder folder;
  std::vector<std::string> seeds = {kHalfDisc};
  for (const Solid& solid : {plate_with_hole(0.5), elbow()}) {
    write_solid_step(solid, folder.path() + "/a.step");
    seeds.push_back(bytes_of_file(folder.path() + "/a.step"));
  }
  return seeds;
}

}  // namespace sketchsplat

namespace {

using namespace sketchsplat;

constexpr unsigned kSeconds = 600;  // of CPU, of a session
constexpr int kFiles = 1000;        // of a session: Open CASCADE leaks

// A signal ends this process after so many seconds of CPU.
void end_after(double seconds) {
  const auto whole = time_t(seconds);
  const itimerval limit = {{0, 0}, {whole, suseconds_t(1e6 * (seconds - double(whole)))}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

// A process that reads one file after the other, several times as fast as a process for each.
// First what runs in a child of its own elsewhere: if it ends there, users see the file refused.
class Session {
 public:
  enum Outcome { kCrashed, kGuarded, kDone };

  explicit Session(std::string path) : path_(std::move(path)) {}
  ~Session() { end(); }
  Session(const Session&) = delete;

  /// What became of the file: Open CASCADE ended the session, we did, or it was read or refused.
  Outcome read() {
    if (files_ == kFiles) end();
    if (!process_.joinable()) begin();
    ++files_;
    int answers = kCrashed;
    char answer = 'n';
    for (bool up = send(ends_[0], "r", 1, MSG_NOSIGNAL) == 1; up && answers < kDone; ++answers)
      if (recv(ends_[0], &answer, 1, 0) != 1) break;
    if (answers < kDone) end();
    return Outcome(answers);
  }

 private:
  void begin() {
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends_) != 0) throw std::runtime_error("no sockets");
    files_ = 0;
    process_ = std::thread([this] {
      run_in_child([this] { return serve(); }, kSeconds);
      shutdown(ends_[1], SHUT_RDWR);
    });
  }
  void end() {
    if (!process_.joinable()) return;
    shutdown(ends_[0], SHUT_RDWR);
    process_.join();
    for (const int fd : ends_) close(fd);
  }
  std::string serve() const {
    for (char order; recv(ends_[1], &order, 1, 0) == 1;) {
      end_after(0.2);
      std::optional<Brep> brep;
      read_or_refuse([&] { brep = read_step(path_); });
      send(ends_[1], "g", 1, MSG_NOSIGNAL);
      end_after(5);
      if (brep) read_or_refuse([&] { cad_part_of(*brep, path_, 1); });
      send(ends_[1], "d", 1, MSG_NOSIGNAL);
    }
    return "";
  }

  const std::string path_;
  std::thread process_;
  int ends_[2] = {-1, -1};
  int files_ = 0;
};

// What Open CASCADE sets up when it reads its first file, children inherit.
bool read_once(const FuzzFolder& folder) {
  read_step_shape(folder.write("seed.step", fuzz_seeds().front()));
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  static const FuzzFolder folder;
  static const bool ready = read_once(folder);
  static Session session(folder.path() + "/part.step");
  const std::string text = text_of(data, size);
  if (!ready || text.rfind("ISO-10303-21;", 0) != 0) return 0;  // refused at once, a test says so
  const std::string path = folder.write("part.step", text);
  if (session.read() == Session::kGuarded) read_or_refuse([&] { read_cad_part(path, 1); });
  return 0;
}
