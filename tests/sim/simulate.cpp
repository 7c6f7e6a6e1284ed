// simulate --seed N [--count M] [--seconds S]: runs seeds of the simulated world and tells what became of them.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "tests/sim/world.hpp"

namespace {
/// A minute of three clients has many times as many.
constexpr std::uint64_t kLeastReplies = 500;
}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Runs seeds of the simulated world. Exit 1 at the first that breaks an invariant."};
  std::uint64_t seed = 1;
  std::uint64_t count = 1;
  int seconds = 60;
  app.add_option("--seed", seed, "first seed");
  app.add_option("--count", count, "how many seeds");
  app.add_option("--seconds", seconds, "virtual seconds each");
  CLI11_PARSE(app, argc, argv);
  for (std::uint64_t s = seed; s < seed + count; ++s) {
    axisgate::test::World world(s);
    world.run(std::chrono::seconds(seconds));
    if (world.violations().empty()) world.recover();
    std::printf("seed %llu: hash %016llx, %s\n", static_cast<unsigned long long>(s),
                static_cast<unsigned long long>(world.hash()), world.summary().c_str());
    for (const std::string& violation : world.violations()) std::printf("  VIOLATION %s\n", violation.c_str());
    std::fflush(stdout);
    if (!world.violations().empty()) return 1;
    if (world.asked().replies <= kLeastReplies * static_cast<std::uint64_t>(seconds) / 60) {
      std::printf("  NOTHING HAPPENED: a run that proves nothing\n");
      return 1;
    }
  }
  return 0;
}
