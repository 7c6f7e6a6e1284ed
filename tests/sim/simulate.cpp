// simulate --seed N [--count M] [--seconds S]: runs seeds of the simulated world and tells what became of them.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <algorithm>
#include <cstdlib>

#include "tests/sim/world.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Runs seeds of the simulated world. Exit 1 at the first seed that breaks an invariant."};
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
    if (getenv("DBG") && !world.violations().empty()) {
      double back = atof(getenv("DBG"));
      auto& link = world.dbg().can_link(world.dbg().gateway().bus_count() - 1);
      auto now = world.dbg().runtime().now();
      std::vector<std::pair<axisgate::Instant, std::string>> all;
      auto ms = [](auto t) { return std::chrono::duration<double, std::milli>(t.time_since_epoch()).count(); };
      char buf[200];
      for (auto& f : link.sent) if (ms(now) - ms(f.at) < back) { snprintf(buf, 200, "%12.3f -> %03x %s", ms(f.at), f.frame.id, axisgate::hex_text(f.frame.bytes()).c_str()); all.push_back({f.at, buf}); }
      for (auto& f : link.received) if (ms(now) - ms(f.at) < back) { snprintf(buf, 200, "%12.3f <-          %03x %s", ms(f.at), f.frame.id, axisgate::hex_text(f.frame.bytes()).c_str()); all.push_back({f.at, buf}); }
      std::stable_sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.first < b.first; });
      for (auto& a : all) printf("%s\n", a.second.c_str());
      for (auto& l : world.dbg().log()) printf("log %s\n", l.c_str());
      for (std::size_t d = 0; d < 3; ++d) printf("node %d state %s\n", static_cast<int>(d), std::string(axisgate::simulated::name_of(link.line().node(d).state())).c_str());
    }
    for (const std::string& violation : world.violations()) std::printf("  VIOLATION %s\n", violation.c_str());
    std::fflush(stdout);
    if (!world.violations().empty()) return 1;
  }
  return 0;
}
