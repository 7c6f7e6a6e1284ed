// SPDX-License-Identifier: Apache-2.0
// The tables of cycles of schemas/register-map.md, played as they stand on each drive that has their commands.
#include "gateway/listing/commands_page.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include "gateway/image/register_map.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

struct Named {
  std::string name;
  std::int64_t value = 0;
};

/// "command 6, command_id 3", "coil 2 = 1"
std::vector<Named> named_values(std::string_view text) {
  std::vector<Named> out;
  while (!text.empty()) {
    const std::size_t comma = text.find(", ");
    const std::string_view each = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 2);
    const std::size_t blank = each.rfind(' ');
    const std::size_t end_of_name = each.substr(0, blank).ends_with(" =") ? blank - 2 : blank;
    Named named{std::string(each.substr(0, end_of_name))};
    const std::string_view digits = each.substr(blank + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), named.value);
    if (error != std::errc() || end != digits.data() + digits.size()) throw std::logic_error(std::string(each));
    out.push_back(std::move(named));
  }
  return out;
}

std::uint16_t offset_of(const std::string& name) {
  for (const RegisterRow& row : register_table(Block::axis).rows())
    if (row.name == name) return row.offset;
  throw std::logic_error("no row is called " + name);
}

class Replay {
 public:
  Replay(const listing::CycleTable& table, Subject subject)
      : table_(table), plant_(subject, table.leases ? with_leases() : PlantOptions{}) {
    plant_.ready_but_disabled();
  }

  void play() {
    int number = 0;
    for (const listing::Cycle& cycle : table_.cycles) {
      SCOPED_TRACE(testing::Message() << table_.title << ", cycle " << ++number << ": " << cycle.client << ' '
                                      << cycle.writes);
      play(cycle);
      if (testing::Test::HasFailure()) return;
    }
  }

 private:
  void play(const listing::Cycle& cycle) {
    const bool panel = cycle.client == "panel";
    Client& client = panel ? plant_.b : plant_.a;
    const bool turned = plant_.velocity() != 0;
    const std::vector<Named> writes = named_values(cycle.writes);
    const bool singles = panel || table_.plc == listing::CycleTable::How::single;
    if (singles) {
      for (const Named& each : writes) EXPECT_EQ(single(client, each).exception, cycle.exception);
    } else {
      for (const Named& each : writes) image_[offset_of(each.name)] = each.value;
      EXPECT_EQ(scan().exception, cycle.exception);
    }
    if (const auto target = image_.find(row::target_position); target != image_.end()) target_ = target->second;
    watch_motor(cycle.motor, turned);
    if (cycle.result != listing::kAsBefore) {
      EXPECT_EQ(client.result(), cycle.result) << cycle.why;
    }
    // After a stop the drive is read once more before it counts as standing.
    static_cast<void>(passes_until([&] { return client.word(shown::axis_state) == cycle.state; }, 1s));
    EXPECT_EQ(client.word(shown::axis_state), cycle.state) << cycle.why;
  }

  void watch_motor(listing::MotorDoes does, bool turned) {
    switch (does) {
      case listing::MotorDoes::stands:
        EXPECT_FALSE(turned);
        for (int i = 0; i < 10; ++i) {
          pass(50ms);
          EXPECT_EQ(plant_.velocity(), 0);
        }
        return;
      case listing::MotorDoes::starts:
        EXPECT_FALSE(turned);
        EXPECT_TRUE(passes_until([this] { return std::llabs(plant_.velocity()) > kAtSpeed; }, 1s));
        return;
      case listing::MotorDoes::arrives:
        EXPECT_TRUE(turned);
        EXPECT_TRUE(passes_until([this] { return plant_.stands(); }, 5s));
        EXPECT_NEAR(static_cast<double>(plant_.position()), static_cast<double>(target_), kClose);
        return;
      case listing::MotorDoes::stops:
        EXPECT_TRUE(turned);
        EXPECT_TRUE(passes_until([this] { return plant_.stands(); }, 5s));
        EXPECT_GT(std::llabs(plant_.position() - target_), kClose);
        return;
    }
  }

  Answer single(Client& client, const Named& write) {
    if (table_.new_connection_each) {
      client.disconnect();
      client.connect();
    }
    constexpr std::string_view kCoil = "coil ";
    if (write.name.starts_with(kCoil))
      return client.coil(static_cast<std::uint16_t>(std::stoi(write.name.substr(kCoil.size()))), write.value != 0);
    if (write.name == "target_position") target_ = write.value;
    return client.row(offset_of(write.name), write.value);
  }
  Answer scan() {
    scans_ = true;
    return plant_.a.rows(row::controlword, row::command_id, image_);
  }
  /// A scanner does not pause.
  void pass(Duration time) {
    plant_.run(time);
    if (scans_) static_cast<void>(scan());
  }
  template <class Condition>
  bool passes_until(const Condition& condition, Duration limit) {
    for (Duration passed{}; passed < limit; passed += 20ms) {
      if (condition()) return true;
      pass(20ms);
    }
    return condition();
  }

  static constexpr std::int64_t kAtSpeed = 1000;  ///< 0.001 rpm: more than a standing motor shows
  const listing::CycleTable& table_;
  Plant plant_;
  Rows image_{{row::command, 0}, {row::command_id, 0}};
  std::int64_t target_ = 0;
  bool scans_ = false;
};

class Cycles : public testing::TestWithParam<Subject> {};

TEST_P(Cycles, AreWhatTheirTablesSay) {
  // As the table of the one-shot client says, and SECURITY.md.
  const bool ends_with_its_client = !is_cia402(GetParam()) && !minds_silence(GetParam());
  for (const listing::CycleTable& table : listing::cycle_tables())
    if (!(table.new_connection_each && ends_with_its_client)) Replay(table, GetParam()).play();
}

// A test of tables that say nothing would pass.
TEST(CycleTables, MoveAndStopAMotorAndEachIsRefusedOnce) {
  ASSERT_EQ(listing::cycle_tables().size(), 5U);
  for (const listing::CycleTable& table : listing::cycle_tables()) {
    std::set<listing::MotorDoes> seen;
    for (const listing::Cycle& cycle : table.cycles) seen.insert(cycle.motor);
    EXPECT_EQ(seen.size(), 4U) << table.title;
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Cycles, testing::ValuesIn(subjects(has_positions)), named);

}  // namespace
}  // namespace axisgate::test::obey
