// What the contract says of a sequence of writes: a small, slow, obvious reference. It knows plain numbers, and each
// rule stands beside its sentence. Where a sentence can be read in two ways both are allowed: the reference then keeps
// a world for each reading, and an answer that fits only some of them ends the others.
// Promises to know nothing of the gateway: it includes nothing of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/obey/write.hpp"

namespace axisgate::test::obey {

/// What somebody beside the machine sees when a write is made.
struct Seen {
  std::int64_t now_ms = 0;
  std::int64_t position = 0;
  bool stands = true;
  bool clear = true;  ///< it has been standing, or moving, for a while: nobody could see it otherwise
};

/// One thing that acts by edges, as one client has written it.
struct Item {
  std::optional<std::int64_t> value{};  ///< none: empty memory
  std::int64_t written_ms = 0;
  bool spoilt = false;   ///< another client's stop since it acted
  bool changed = false;  ///< this client has changed one of its targets since it acted
  bool ended = false;    ///< a stop or another client since it acted
  bool refused = false;  ///< it was not carried out
  bool acted = false;    ///< ever; else it was only remembered
  bool operator==(const Item&) const = default;
};

struct ClientMemory {
  Item command, controlword;
  std::array<Item, 10> coils{};
  std::optional<std::int64_t> id{};  ///< the last one that was not 0
  Rows rows{};                       ///< as written last, whatever became of it
  bool operator==(const ClientMemory&) const = default;
};

enum class Motor : std::uint8_t { stands, moves, runs, unknown };

/// One reading of all that was written so far.
struct World {
  std::array<ClientMemory, 2> clients{};
  Rows accepted{};
  std::optional<std::size_t> owner{};
  bool enabled = true;
  bool latched = false;
  bool held = false;                       ///< coil 3 is 1
  std::int64_t ladder = 15;                ///< the last raw step of CiA 402 that was taken: 0, 6, 7 or 15
  std::optional<std::int64_t> raw_mode{};  ///< written to row 41 since the last command that selects a mode
  bool start_bit = false;                  ///< bit 4 may be set in the controlword in effect
  bool stale_speed = false;                ///< the speed was accepted before a stop
  Motor motor = Motor::stands;
  std::int64_t target = 0;  ///< of the move
  std::int64_t started_ms = 0;
  bool operator==(const World&) const = default;
};

struct Verdict {
  std::string says{};        ///< for people
  std::set<int> answers{0};  ///< exceptions that fit; 0: none
  bool any_answer = false;
};

struct ContractOptions {
  bool leases = false;
  std::set<std::uint16_t> rows{};  ///< set-points the drive has
  bool no_halt = false;            ///< of a move: the profile stops it by what may latch the axis
  bool by_gateway = false;         ///< the CiA 402 machine is the gateway's
};

class Contract {
 public:
  Contract(ContractOptions options, World start) : options_(std::move(options)), worlds_{std::move(start)} {}

  /// Before the write is sent. Tells what is predicted, one line for each reading.
  std::string write(std::size_t client, const Write& write, const Seen& seen);
  /// What was answered. False: no reading of the contract has this answer.
  bool answered(int exception);
  /// Readings that fit what the motor does in the end.
  [[nodiscard]] bool ends_with(std::int64_t position, std::int64_t velocity, std::optional<bool> enabled) const;
  [[nodiscard]] std::string expected_end() const;
  [[nodiscard]] const std::vector<World>& worlds() const { return worlds_; }
  /// A motor that nobody can foretell is no test of anything.
  [[nodiscard]] bool knows_the_end() const;

 private:
  static constexpr std::size_t kMaxWorlds = 400;
  ContractOptions options_;
  std::vector<World> worlds_;
  std::vector<Verdict> verdicts_;
};

}  // namespace axisgate::test::obey
