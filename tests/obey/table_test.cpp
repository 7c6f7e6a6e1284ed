// What was asked last is what happens: random writes, then a start; where the motor ends is compared with the contract.
// AXISGATE_OBEY_SEEDS: how many sequences for each drive (4). AXISGATE_OBEY_SEED: this one alone, to replay it.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/contract.hpp"
#include "tests/obey/plant.hpp"
#include "tests/obey/sequence.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr int kWrites = 50;
constexpr std::uint64_t kSeeds = 4;
constexpr std::int64_t kClearMs = 250;  // so long standing or moving: no doubt about it

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

/// Who can tell whether it stands.
class Watch {
 public:
  explicit Watch(Plant& plant) : plant_(plant), began_(plant.stage.runtime().now()), since_(began_) { look(); }
  void look() {
    const bool stands = plant_.velocity() == 0;
    if (stands != stands_) since_ = plant_.stage.runtime().now();
    stands_ = stands;
  }
  void run(Duration time) {
    for (const Instant end = plant_.stage.runtime().now() + time; plant_.stage.runtime().now() < end; look())
      plant_.run(5ms);
  }
  Seen seen() {
    look();
    const Instant now = plant_.stage.runtime().now();
    return {elapsed_ms(began_, now), plant_.position(), stands_,
            elapsed_ms(since_, now) >= kClearMs || since_ == began_};
  }

 private:
  Plant& plant_;
  Instant began_;
  Instant since_;
  bool stands_ = true;
};

class Play {
 public:
  Play(Subject subject, std::uint64_t seed, bool leases)
      : leases_(leases),
        plant_(subject, leases ? PlantOptions{LeaseRules{}, {}, seed} : PlantOptions{{}, {}, seed}),
        sequence_(subject, seed, leases ? 1 : 2, [this] {
          plant_.ready();
          return plant_.profile_rows();
        }()) {
    ContractOptions options;
    options.leases = leases;
    options.no_halt = is_kinco(subject) && !is_md(subject) && sequence_.flavour() != Flavour::speeds;
    options.by_gateway = !is_cia402(subject);
    if (has_positions(subject)) options.rows.insert(row::target_position);
    if (has_speeds(subject)) options.rows.insert(row::target_velocity);
    options.rows.insert(row::mode);
    World world;
    world.accepted = {{row::target_position, 0}, {row::target_velocity, 0}};
    watch_ = std::make_unique<Watch>(plant_);
    contract_ = std::make_unique<Contract>(options, world);
    heading_ = name(subject) + ", seed " + std::to_string(seed) + (leases ? ", leases on" : ", leases off");
  }

  void play() {
    if (sequence_.flavour() != Flavour::both)
      step({0, one(row::mode, sequence_.flavour() == Flavour::moves ? 1 : 3), 50});
    for (int i = 0; i < kWrites; ++i) step(sequence_.next());
    for (const Step& last : sequence_.ending()) step(last);
    for (int i = 0; i < 20; ++i) {
      watch_->run(250ms);
      if (leases_) plant_.a.word(shown::axis_state);
    }
    const Truth truth = plant_.motor();
    EXPECT_TRUE(contract_->ends_with(truth.position, truth.velocity, truth.enabled))
        << "the motor is at " << truth.position << ", velocity " << truth.velocity
        << (truth.enabled ? *truth.enabled ? ", enabled" : ", disabled" : "")
        << "; the contract: " << contract_->expected_end() << "\n"
        << story();
    EXPECT_EQ(wrong_answers_, 0) << story();
  }

 private:
  void step(const Step& step) {
    const Seen seen = watch_->seen();
    Client& client = step.client == 0 ? plant_.a : plant_.b;
    std::string line = std::to_string(++steps_) + ". " + std::to_string(seen.now_ms) + " ms, at " +
                       std::to_string(seen.position) + (seen.stands ? "" : " turning") + ": " + text(step);
    line += "  -> " + contract_->write(step.client, step.write, seen);
    const Answer answer = client.write(step.write);
    line += "  [" + (answer.ok() ? std::string("ok") : "exception " + std::to_string(answer.exception)) + "]";
    if (!contract_->answered(answer.exception)) {
      ++wrong_answers_;
      line += "  <-- NO READING HAS THIS ANSWER";
    }
    if (contract_->worlds().size() > 1) line += "  (" + std::to_string(contract_->worlds().size()) + " readings)";
    told_.push_back(line + "\n      then: " + contract_->expected_end());
    watch_->run(std::chrono::milliseconds(step.pause_ms));
  }

  std::string story() const {
    std::string out = heading_ + "\n";
    for (const std::string& line : told_) out += line + "\n";
    return out;
  }

  bool leases_;
  Plant plant_;
  Sequence sequence_;
  std::unique_ptr<Watch> watch_;
  std::unique_ptr<Contract> contract_;
  std::string heading_;
  std::vector<std::string> told_;
  int steps_ = 0;
  int wrong_answers_ = 0;
};

class AskedLast : public testing::TestWithParam<Subject> {
 protected:
  static void play_all(bool leases) {
    const std::uint64_t only = number_from("AXISGATE_OBEY_SEED", 0);
    const std::uint64_t seeds = number_from("AXISGATE_OBEY_SEEDS", kSeeds);
    for (std::uint64_t seed = only != 0 ? only : 1; seed <= (only != 0 ? only : seeds); ++seed)
      Play(GetParam(), seed, leases).play();
  }
};

TEST_P(AskedLast, OfTwoClientsWithoutLeasesIsWhatTheMotorDoes) { play_all(false); }
TEST_P(AskedLast, OfAnOwnerIsWhatTheMotorDoes) { play_all(true); }

INSTANTIATE_TEST_SUITE_P(Every, AskedLast, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
