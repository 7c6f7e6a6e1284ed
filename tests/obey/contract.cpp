#include "tests/obey/contract.hpp"

#include <algorithm>
#include <cstdlib>

#include "tests/obey/judge.hpp"

namespace axisgate::test::obey {
namespace {

constexpr std::int64_t kSpeedShare = 50;  // one part in so many
constexpr std::int64_t kSlowest = 1'500;  // a drive that counts whole rpm

}  // namespace

std::string Contract::write(std::size_t client, const Write& write, const Seen& seen) {
  std::vector<World> worlds;
  verdicts_.clear();
  std::set<std::string> said;
  for (const World& world : worlds_) {
    Readings readings;
    do {
      World next = world;
      Judge judge(options_, next, readings, seen, client);
      Verdict verdict = write.coils() ? judge.coils(write) : judge.registers(write);
      said.insert(verdict.says);
      if (worlds.size() < kMaxWorlds) {
        worlds.push_back(std::move(next));
        verdicts_.push_back(std::move(verdict));
      }
    } while (readings.advance());
  }
  worlds_ = std::move(worlds);
  std::string out;
  for (const std::string& one : said) out += (out.empty() ? "" : " | ") + one;
  return out;
}

bool Contract::answered(int exception) {
  std::vector<World> fitting;
  for (std::size_t i = 0; i < worlds_.size(); ++i)
    if (verdicts_[i].any_answer || verdicts_[i].answers.contains(exception)) fitting.push_back(worlds_[i]);
  const bool fits = !fitting.empty();
  const std::vector<World>& kept = fits ? fitting : worlds_;
  std::vector<World> different;
  for (const World& world : kept)
    if (std::ranges::find(different, world) == different.end()) different.push_back(world);
  worlds_ = std::move(different);
  return fits;
}

bool Contract::knows_the_end() const {
  return std::ranges::none_of(worlds_, [](const World& w) { return w.motor == Motor::unknown; });
}

bool Contract::ends_with(std::int64_t position, std::int64_t velocity, std::optional<bool> enabled) const {
  return std::ranges::any_of(worlds_, [&](const World& w) {
    // After a quick stop the drive is in the state it goes to by itself (3.4, command 3).
    if (enabled && !w.latched && w.motor != Motor::unknown && *enabled != w.enabled) return false;
    const auto speed = w.accepted.contains(row::target_velocity) ? w.accepted.at(row::target_velocity) : 0;
    switch (w.motor) {
      case Motor::stands:
        return velocity == 0;
      case Motor::moves:
        return velocity == 0 && std::abs(position - w.target) <= kClose;
      case Motor::runs:
        return speed == 0 ? velocity == 0
                          : std::abs(velocity - speed) <= std::max(std::abs(speed) / kSpeedShare, kSlowest);
      case Motor::unknown:
        return true;
    }
    return false;
  });
}

std::string Contract::expected_end() const {
  std::set<std::string> ends;
  for (const World& w : worlds_) {
    std::string end = w.latched ? "latched, " : w.enabled ? "enabled, " : "disabled, ";
    if (w.motor == Motor::stands) end += "stands";
    if (w.motor == Motor::moves) end += "at " + std::to_string(w.target);
    if (w.motor == Motor::runs)
      end += "runs at " +
             std::to_string(w.accepted.contains(row::target_velocity) ? w.accepted.at(row::target_velocity) : 0);
    if (w.motor == Motor::unknown) end += "nobody can tell";
    ends.insert(end);
  }
  std::string out;
  for (const std::string& one : ends) out += (out.empty() ? "" : " | ") + one;
  return out;
}

}  // namespace axisgate::test::obey
