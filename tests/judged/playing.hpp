// SPDX-License-Identifier: Apache-2.0
// A program being played before the shipped gateway: who asks what when, what befalls the plant, and what is watched
// beside it. Promises that after each 5 ms contract and watches have seen what motor, cable and clients show. Never
// decides what is right.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/judged/beginning.hpp"
#include "tests/judged/clients.hpp"
#include "tests/judged/history.hpp"
#include "tests/judged/plague.hpp"
#include "tests/judged/play.hpp"
#include "tests/judged/shown.hpp"
#include "tests/judged/watches.hpp"
#include "tests/judged/writers.hpp"

namespace axisgate::test::judged {

class Play {
 public:
  Play(const Program& program, std::uint64_t seed)
      : program_(program),
        seed_(seed),
        neighbour_(seed % 2 == 0),
        other_bus_(seed % 4 == 3),
        plant_(program.subject, options_of(program, seed)),
        clients_(plant_, kStrengths.at(seed % kStrengths.size()), together(seed), seed % 3 == 1),
        plague_(plant_, program_.nemesis, seed) {}

  Outcome run();

 private:
  static constexpr std::int64_t kStepMs = 5;
  /// No request is unanswered for so long (3.3: reply_deadline_ms 900).
  static constexpr std::int64_t kSilenceMs = 10'000;

  static obey::PlantOptions options_of(const Program& program, std::uint64_t seed);
  struct Open {
    int request = 0;
    std::size_t client = 0;
    obey::RequestNumber number = 0;
    std::int64_t sent_ms = 0;
    std::size_t line = 0;
    bool of_object = false;
    bool moves = false;      ///< it may begin a move
    bool repeats = false;    ///< perhaps: "in a block, repeating ... leaves result and detail alone" (3.3 Not new)
    bool posted = false;     ///< the answer comes after the checks, register 25 tells the rest
    bool checked = false;    ///< that answer is there
    bool pending = false;    ///< register 25 has said so
    bool under_way = false;  ///< perhaps: register 25 may have told of an older one
    std::optional<obey::RequestNumber> asked_for_result{};
    bool shows_reached = false;         ///< it was accepted, not answered yet, and target_reached was shown
    std::vector<std::uint16_t> read{};  ///< registers 0 to 38, by the same request (function 23)
  };

  [[nodiscard]] std::int64_t now_ms() { return elapsed_ms(began_, plant_.stage.runtime().now()); }
  void begin();
  void act(const Step& step);
  void send(std::size_t client, reference::Write write, bool at_once);
  void outage(const Step& step);
  void die(const Step& step);
  void pass(std::int64_t ms);
  void look();
  void watch_acceptance();
  void collect();
  void never_answered(const Open& open);
  [[nodiscard]] std::optional<std::string> wrong_beside(const Open& open);
  std::optional<std::set<int>> answer_to(Open& open);
  void lose_sight_of_posted(std::size_t client);
  void write_halves(const Step& step);
  void send_crossed(const Step& step);
  void hold_button(const Step& step);
  void scan(const Step& step);
  void go_on_unaware(const Step& step);
  void use_tool(const Step& step);
  void home_again(const Step& step);
  void use_monitor(const Step& step);
  void take_away(const Step& step);
  void insist(const Step& step);
  void press_out_of_sight(const Step& step);
  void be_commanded_by_another(const Step& step);
  void be_nearly_right(const Step& step);
  void jog_unanswered(const Step& step, std::uint16_t button);
  void follow_each_other(const Step& step);
  void jog_by_dds(const Step& step);
  void say_once_more(const Step& step);
  void kill_dds(const Step& step);
  void beat_in_vain(std::size_t writer, bool too_old);
  void be_alive(std::size_t writer);
  void beat(std::size_t writer, bool counts_on);
  void look_up(std::size_t client);
  void watch_trouble();
  void begin_trouble();
  void be_haunted();
  void mend();
  void replace(std::size_t client, bool silently);
  void read(std::size_t client);
  [[nodiscard]] Shown shown_by(std::vector<std::uint16_t> words) const;
  void violated(std::string what);
  [[nodiscard]] bool over() const { return outcome_.violation.has_value(); }
  [[nodiscard]] std::string stamp();
  [[nodiscard]] bool online() {
    return plant_.stage.gateway_runs() && plant_.stage.axis(1).link_state == LinkState::online;
  }

  Program program_;
  std::uint64_t seed_;
  bool neighbour_, other_bus_;
  obey::Plant plant_;
  Clients clients_;
  Plague plague_;
  std::optional<Writers> writers_;
  std::optional<reference::Contract> contract_;
  std::optional<Watches> watches_;
  Outcome outcome_;
  Instant began_{};
  std::vector<Open> open_;
  History seen_;
  /// The exception that this client's newest request of registers was answered with; none: what register 25 tells is
  /// not known. Of what is done it may tell of an older one, or 10 of another row of the block.
  std::array<std::optional<int>, reference::kModbus> told_{};
  std::array<int, reference::kModbus> newest_{};  ///< of each client, but of objects
  std::set<std::int64_t> ids_{0};                 ///< of commands, that anybody has written
  std::set<std::size_t> looks_at_once_;           ///< clients whose move was just answered
  bool wire_whole_ = true;
  bool another_master_ = false;    ///< has spoken to the drive
  bool was_nearly_right_ = false;  ///< the drive has shown quick stops that stopped nothing
  bool had_outage_ = false;
  std::int64_t whole_since_ms_ = 0;
  std::int64_t online_since_ms_ = -1;
};

}  // namespace axisgate::test::judged
