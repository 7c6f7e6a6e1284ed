// SPDX-License-Identifier: Apache-2.0
// The clients of a run: three of Modbus, three of DDS, and a viewer who passes by, each in the words of its listener.
// Promises to tell of an answer what the contract knows: exceptions, 0 for none, or those that a result may stand for.
// Never judges one.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>

#include "tests/judged/program.hpp"
#include "tests/model/contract.hpp"
#include "tests/obey/dds_writers.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

/// Of the DDS writers, each in some of the runs; 0 as well of a SHARED one.
inline constexpr std::array<std::array<int, reference::kWriters>, 4> kStrengths{
    {{5, 5, 9}, {9, 5, 0}, {0, 0, 5}, {7, 7, 7}}};
inline constexpr std::array<const char*, reference::kClients> kNames{"a", "b", "c", "dds 1", "dds 2", "dds 3"};

class Clients {
 public:
  /// `together`: so many of Modbus have one address, and its role and rank. `operator_c`: c is an operator, else an
  /// engineer as a and b.
  Clients(obey::Plant& plant, const std::array<int, reference::kWriters>& strengths, std::size_t together,
          bool operator_c)
      : plant_(plant),
        strengths_(strengths),
        operators_{false, false, operator_c && together < reference::kModbus},
        b_(plant.connection_from(together > 1 ? obey::Plant::kHostOfA : obey::Plant::kHostOfB)),
        c_(plant.connection_from(together > 2 ? obey::Plant::kHostOfA : kHostOfC)),
        modbus_{&plant.a, b_.get(), c_.get()} {
    for (std::size_t client = 0; client < together; ++client) ranks_[client] = ranks_[0];
  }

  /// Each with its rank, before a gateway that runs.
  void connect();
  void gateway_died() { dds_.reset(); }
  [[nodiscard]] bool connected(std::size_t client) const {
    return reference::is_dds(client) ? dds_.has_value() : modbus_[client]->connected();
  }
  std::uint64_t begin(std::size_t client, const reference::Write& write);
  /// None yet, or never. Throws for a DDS result that stands for nothing.
  [[nodiscard]] std::optional<std::set<int>> answer_of(std::size_t client, std::uint64_t request);
  /// Of a posted write that was answered without an exception: what register 25 says became of it.
  struct Posted {
    bool pending = false;
    std::set<int> stands_for{};  ///< with none, nobody can tell
  };
  std::uint64_t ask_for_result(std::size_t client);
  /// None yet.
  [[nodiscard]] std::optional<Posted> posted(std::size_t client, std::uint64_t asked);
  /// A new connection; of DDS another writer, silently: of another participant.
  void replace(std::size_t client, bool silently);
  [[nodiscard]] const std::array<bool, reference::kModbus>& operators() const { return operators_; }
  [[nodiscard]] const std::array<std::uint8_t, reference::kModbus>& ranks() const { return ranks_; }
  [[nodiscard]] obey::DdsWriters& dds() { return *dds_; }
  [[nodiscard]] obey::Client& modbus(std::size_t client) { return *modbus_[client]; }
  /// What was wrong with what a viewer was told for a write (3.3 Roles: 0x01, and nothing changes).
  [[nodiscard]] std::optional<std::string> bystand(const Step& step);

 private:
  static constexpr std::uint8_t kHostOfC = 50;
  obey::Plant& plant_;
  std::array<int, reference::kWriters> strengths_;
  /// Of `allow`: command 14 takes an axis from a lower one.
  std::array<std::uint8_t, reference::kModbus> ranks_{5, 3, 4};
  std::array<bool, reference::kModbus> operators_;
  std::unique_ptr<obey::Client> b_, c_;
  std::array<obey::Client*, reference::kModbus> modbus_;
  std::optional<obey::DdsWriters> dds_;
  std::uint8_t participant_ = 0;
};

}  // namespace axisgate::test::judged
