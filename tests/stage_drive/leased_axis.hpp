// SPDX-License-Identifier: Apache-2.0
// An axis with a lease, its owner and a second client, and the words in which tests of leases and jogs speak.
// Promises that a client asks for nothing by itself. Never decides what is right: the tests do.
#pragma once

#include <gtest/gtest.h>

#include "tests/stage_drive/rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {

[[nodiscard]] inline RigOptions leased(LeaseAction on_expiry = LeaseAction::quick_stop,
                                       LeaseRenewal renew = LeaseRenewal::any) {
  RigOptions options;
  options.lease = LeaseRules{.on_expiry = on_expiry, .renew = renew};
  return options;
}

struct LeasedAxis {
  explicit LeasedAxis(const RigOptions& options = leased()) : rig(KincoType::jd, options) { rig.online(); }

  Rig rig;
  std::shared_ptr<ClientLife> plc = client(1, "10.0.0.1");
  std::shared_ptr<ClientLife> panel = client(2, "10.0.0.2");

  WriteBatch from(const std::shared_ptr<ClientLife>& who, WriteBatch batch, bool claims = true) {
    who->last_request = rig.stage.runtime().now();
    batch.client = who->id;
    batch.role = who->role;
    batch.life = who;
    batch.claims = claims;
    return batch;
  }
  Errc ask(const std::shared_ptr<ClientLife>& who, WriteBatch batch, bool claims = true) {
    return rig.ask(from(who, std::move(batch), claims)).outcome.code;
  }
  Errc command(const std::shared_ptr<ClientLife>& who, Command command) {
    return ask(who, with_command(command), !is_stop(command) && command < Command::release);
  }
  /// Enabled and running, by this client.
  void run(const std::shared_ptr<ClientLife>& who) {
    EXPECT_EQ(command(who, Command::enable), Errc::ok);
    EXPECT_EQ(ask(who, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}})), Errc::ok);
    EXPECT_TRUE(rig.stage.run_until([&] {
      who->last_request = rig.stage.runtime().now();
      return rig.axis().has(AxisInput::moving);
    }));
  }
  /// The client goes on asking for so long.
  void keep(const std::shared_ptr<ClientLife>& who, Duration time) {
    for (Duration done{}; done < time; done += std::chrono::milliseconds(100)) {
      who->last_request = rig.stage.runtime().now();
      rig.stage.run(std::chrono::milliseconds(100));
    }
  }
  bool latched() { return rig.axis().has(AxisInput::stop_latched); }
  bool event(const std::string& part) { return rig.has_event(EventKind::lease, part); }
};

}  // namespace axisgate::test
