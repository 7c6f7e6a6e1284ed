// SPDX-License-Identifier: Apache-2.0
// The clients of a run: three of Modbus, one of DDS, and a viewer who passes by, each in the words of its listener.
// Promises to tell of an answer what the contract knows: exceptions, 0 for none, or those that a result may stand for.
// Never judges one.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>

#include "tests/judged/program.hpp"
#include "tests/model/contract.hpp"
#include "tests/obey/dds_writer.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

/// Of `allow`: command 14 takes an axis from a lower one.
inline constexpr std::array<std::uint8_t, model::kDds> kRanks{5, 3, 4};
inline constexpr std::array<const char*, model::kClients> kNames{"a", "b", "c", "dds"};

class Clients {
 public:
  explicit Clients(obey::Plant& plant)
      : plant_(plant), c_(plant.connection_from(kHostOfC)), modbus_{&plant.a, &plant.b, c_.get()} {}

  /// Each with its rank, before a gateway that runs.
  void connect();
  void gateway_died() { dds_.reset(); }
  [[nodiscard]] bool connected(std::size_t client) const {
    return client == model::kDds ? dds_.has_value() : modbus_[client]->connected();
  }
  std::uint64_t begin(std::size_t client, const model::Write& write);
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
  /// A new connection; of DDS another writer.
  void replace(std::size_t client, bool silently);
  [[nodiscard]] obey::Client& modbus(std::size_t client) { return *modbus_[client]; }
  /// What was wrong with what a viewer was told for a write (3.3 Roles: 0x01, and nothing changes).
  [[nodiscard]] std::optional<std::string> bystand(const Step& step);

 private:
  static constexpr std::uint8_t kHostOfC = 50;
  obey::Plant& plant_;
  std::unique_ptr<obey::Client> c_;
  std::array<obey::Client*, model::kDds> modbus_;
  std::optional<obey::DdsWriter> dds_;
  std::uint8_t participant_ = 0;
};

}  // namespace axisgate::test::judged
