// What an ensemble shows on a terminal: the test brings one of its own.
#include <delassus/study/ensemble.hpp>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include "catch.hpp"
#include "study/slides.hpp"
#include "study/worker_threads.hpp"

namespace ensemble_progress_tests {

using namespace slides;

namespace {

/// A terminal in place of stderr, until `seen` gives what came to it.
class Terminal {
 public:
  Terminal() {
    main_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (main_ < 0 || ::grantpt(main_) != 0 || ::unlockpt(main_) != 0) return;
    const char* name = ::ptsname(main_);
    const int end = name ? ::open(name, O_RDWR | O_NOCTTY) : -1;
    if (end < 0) return;
    before_ = ::dup(2);
    ::dup2(end, 2);
    ::close(end);
  }
  ~Terminal() {
    if (is_there()) seen();
    if (main_ >= 0) ::close(main_);
  }
  bool is_there() const { return before_ >= 0; }
  std::string seen() {
    std::fflush(stderr);
    std::string text;
    char part[256];
    for (ssize_t count; (count = ::read(main_, part, sizeof part)) > 0;) text.append(part, std::size_t(count));
    ::dup2(before_, 2);
    ::close(before_);
    before_ = -1;
    return text;
  }

 private:
  int main_ = -1, before_ = -1;
};

std::string shown(bool is_quiet, Index workers) {
  const EnsemblePlan plan{.name = "slides", .steps = 64, .h = 0.01, .observations = {"low (m)"}, .is_quiet = is_quiet};
  const Ensemble ensemble{make_slide, std::vector{0.1, 0.2, 0.3, 0.4}};
  Terminal terminal;
  if (!terminal.is_there()) return "no terminal";
  ensemble.run(plan, [](const Loop& loop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(110));  // the line is written ten times a second
    return places(loop)[0];
  }, WorkerThreads(workers));
  return terminal.seen();
}

}  // namespace

TEST_CASE("an ensemble says on a terminal how far it is, and takes the line away at the end") {
  for (const Index workers : {1, 2}) {
    const std::string text = shown(false, workers);
    if (text == "no terminal") {
      WARN("no terminal can be had here");
      return;
    }
    CAPTURE(text, workers);
    CHECK(text.find("slides  [") != std::string::npos);
    CHECK(text.find(" 100 %") != std::string::npos);
    CHECK(text.ends_with("\r\033[K"));
    CHECK(shown(true, workers).empty());
  }
}

}  // namespace ensemble_progress_tests
