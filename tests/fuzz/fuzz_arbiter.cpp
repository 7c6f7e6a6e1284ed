// SPDX-License-Identifier: Apache-2.0
// The arbiter, its operations read from bytes; each answer is held against the reference of its own tests.
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/unit/bus/arbiter_reference.hpp"

namespace axisgate::fuzz {
namespace {

using namespace std::chrono_literals;
using test::ArbiterReference;
using test::BusJob;
using test::JobId;
using test::Priority;

/// The reference objects by gtest's expectations: the first objection ends the input.
class Objections final : public testing::EmptyTestEventListener {
 public:
  Objections() { testing::UnitTest::GetInstance()->listeners().Append(this); }
  Objections(const Objections&) = delete;
  Objections& operator=(const Objections&) = delete;
  ~Objections() override { testing::UnitTest::GetInstance()->listeners().Release(this); }
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed() && first.empty()) first = result.message();
  }
  std::string first;
};

class ArbiterPlay {
 public:
  explicit ArbiterPlay(Input input) : input_(input) {}

  void run() {
    for (int steps = 0; input_.more() && steps < 4096; ++steps) {
      step();
      if (!objections_.first.empty()) throw FuzzFault(objections_.first);
    }
  }

 private:
  void step() {
    const std::uint8_t operation = input_.byte();
    const std::uint8_t argument = operation >> 4;
    switch (operation & 15) {
      case 0:
      case 1:
      case 2:
        submit();
        break;
      case 3:
      case 4:
        grant();
        break;
      case 5:
      case 6:
        end_exchange(argument);
        break;
      case 7:
        if (const JobId id = any_job(argument); id != 0) {
          const Instant until = now_ + std::chrono::milliseconds(input_.byte());
          reference_.on_wait(id, until);
          arbiter_.wait(id, until);
        }
        break;
      case 8:
        if (const JobId id = any_job(argument); id != 0) finish(id);
        break;
      case 9:
      case 10: {
        const auto drive = static_cast<DriveSlot>(argument % ArbiterReference::kDrives);
        const std::uint8_t in = input_.byte();
        const Instant due = in == 255 ? kNever : now_ + std::chrono::milliseconds(in);
        reference_.on_poll_due(drive, due);
        arbiter_.set_poll_due(drive, due);
        break;
      }
      case 11:
        now_ += std::chrono::milliseconds(argument);
        break;
      case 12:
        now_ += std::chrono::milliseconds(input_.byte() * 4);
        break;
      case 13:
        take_endings();
        break;
      case 14: {
        const auto drive = static_cast<DriveSlot>(argument % ArbiterReference::kDrives);
        reference_.on_end(drive, Errc::offline, Errc::timed_out);
        arbiter_.end_drive(drive, Errc::offline, Errc::timed_out);
        break;
      }
      default:
        reference_.on_end(std::nullopt, Errc::offline, Errc::link_lost);
        arbiter_.end_all(Errc::offline, Errc::link_lost);
        break;
    }
  }
  void submit() {
    const std::uint8_t what = input_.byte();
    const std::uint8_t how = input_.byte();
    BusJob job = test::job(static_cast<Priority>(what % 5), static_cast<DriveSlot>((what >> 3) % 3),
                           static_cast<AxisSlot>((what >> 5) & 1));
    if ((what & 0x80) != 0 || job.priority == Priority::setup) job.axis = kNoAxis;
    if ((how & 1) != 0) job.start_by = now_ + std::chrono::milliseconds(how >> 2);
    job.survives_stop = (how & 2) != 0;
    if (job.priority == Priority::command && (how & 4) != 0) {
      job.setpoints_only = true;
      job.writes.push_back((how & 8) != 0 ? test::kTargetPosition : test::kProfileVelocity);
    } else if ((how & 16) != 0) {
      job.read = {(how & 8) != 0 ? test::kStatusword : test::kTargetPosition,
                  static_cast<std::uint8_t>((how & 32) != 0 ? 2 : 4)};
    }
    reference_.on_submit(job, arbiter_.submit(job, now_), now_);
  }
  void grant() {
    if (const auto granted = arbiter_.next(now_)) {
      reference_.on_grant(*granted, now_);
    } else {
      reference_.on_nothing(now_);
    }
  }
  void end_exchange(std::uint8_t how) {
    must(arbiter_.wire_busy() == reference_.busy(), "the wire is busy from a grant to its end");
    if (!reference_.busy()) return;
    if (how == 15) {
      reference_.on_decline();
      arbiter_.decline();
      return;
    }
    const bool lost = (how & 1) != 0;
    const Instant silent_until = now_ + std::chrono::milliseconds(how / 4);
    reference_.on_over(silent_until, lost);
    arbiter_.exchange_over(silent_until, lost);
  }
  void finish(JobId id) {
    reference_.on_finish(id);
    arbiter_.finish(id);
  }
  void take_endings() {
    for (bool more = true; more;) {
      const auto ending = arbiter_.take_ending(now_);
      reference_.on_ending(ending, now_);
      more = ending.has_value();
    }
  }
  [[nodiscard]] JobId any_job(std::size_t which) const {
    if (reference_.known().empty()) return 0;
    auto at = reference_.known().begin();
    std::advance(at, static_cast<long>(which % reference_.known().size()));
    return at->first;
  }

  Input input_;
  Objections objections_;
  test::Arbiter arbiter_{ArbiterReference::kDrives};
  ArbiterReference reference_;
  Instant now_ = Instant{} + 1h;
};

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_arbiter(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::ArbiterPlay(axisgate::fuzz::Input(data, size)).run();
  return 0;
}
