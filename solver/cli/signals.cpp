#include "cli/signals.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace talus::cli {
namespace {

volatile sig_atomic_t stop_flag = 0;
bool second_ends = true;

extern "C" void on_stop(int number) {
  if (stop_flag != 0 && second_ends) _exit(128 + number);
  stop_flag = 1;
}

}  // namespace

void catch_stop_signals(bool twice_ends) {
  second_ends = twice_ends;
  struct sigaction action {};
  action.sa_handler = on_stop;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return stop_flag != 0; }

bool die_with_parent() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  return getppid() != 1;
}

}  // namespace talus::cli
