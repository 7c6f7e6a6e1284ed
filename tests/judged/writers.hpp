// SPDX-License-Identifier: Apache-2.0
// What each client writes next: a step of a program, resolved by what the same client wrote before. Promises equal
// writes for equal programs, whatever was answered. Never knows what a write will do.
#pragma once

#include "tests/judged/program.hpp"
#include "tests/model/contract.hpp"

namespace axisgate::test::judged {

class Writers {
 public:
  /// `profile`: rows 48 to 52 as the drive holds them; client a has them in its blocks, b writes zeros.
  /// `commands`: register 36, one bit for each that the drive has.
  /// `parameters`: what the drive holds in the rows 46, 47 and 62 to 76 that it has.
  Writers(const Program& program, reference::Rows profile, reference::Rows parameters, std::uint32_t commands)
      : subject_(program.subject),
        flavour_(program.flavour),
        leases_(program.leases),
        profile_(std::move(profile)),
        parameters_(std::move(parameters)),
        commands_(commands) {}

  [[nodiscard]] reference::Write write_of(const Step& step);
  /// Its program begins anew, and its ids with it.
  void started_anew(std::size_t client) { writers_.at(client) = {}; }
  void sent(std::size_t client, const reference::Write& write) { writers_.at(client).last = write; }

 private:
  struct Writer {
    std::int64_t id = 0;
    reference::Rows rows{};  ///< targets, as written last
    std::int64_t word = 0;
    reference::Write last{};
  };
  [[nodiscard]] reference::Write registers(const Step& step);
  [[nodiscard]] reference::Write parameter(const Step& step) const;
  [[nodiscard]] std::int64_t start_command(const Step& step) const;
  [[nodiscard]] std::int64_t next_word(const Step& step, Writer& writer) const;

  Subject subject_;
  Flavour flavour_;
  bool leases_;
  reference::Rows profile_, parameters_;
  std::uint32_t commands_;
  std::array<Writer, reference::kClients> writers_{};
};

}  // namespace axisgate::test::judged
