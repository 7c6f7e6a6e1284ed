// The simulated world of one seed: the shipped core with two Kinco drives on their own protocol, three drives of all
// kinds on a Modbus RTU line, three on a CAN bus, or several of these; three Modbus clients and the faults of the seed.
// Promises that equal seeds give equal hashes, and to keep the first violations with the time of each.
// Never uses real time, sockets or devices.
#pragma once

#include "tests/sim/can_invariants.hpp"
#include "tests/sim/invariants.hpp"
#include "tests/sim/nemesis.hpp"
#include "tests/sim/rtu_invariants.hpp"
#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

class World {
 public:
  explicit World(std::uint64_t seed);
  ~World();

  /// The faults' time: `length` of virtual time.
  void run(Duration length);
  /// Then quiet: faults end, clients stop the axes; everything must come back.
  void recover();

  [[nodiscard]] const std::vector<std::string>& violations() const { return violations_; }
  [[nodiscard]] std::uint64_t hash() const;
  [[nodiscard]] const Asked& asked() const { return asked_; }
  [[nodiscard]] std::string summary();

 private:
  void watch_kinco(std::size_t line);
  void watch_rtu(std::size_t line);
  void watch_can(std::size_t line);
  void check();
  void add_clients();
  void step(Instant until);
  [[nodiscard]] std::uint64_t starts() const;
  [[nodiscard]] std::string seen_on_can() const;
  void violated(const std::string& what);

  Random random_;
  std::vector<GatewayStage::Line> lines_;
  GatewayStage stage_;
  modbus_tcp::ListenerSettings settings_;
  modbus_tcp::ClientRegistry registry_;
  Log quiet_;
  Asked asked_;
  std::vector<std::string> violations_;
  Instant began_;
  std::vector<std::unique_ptr<CableWatch>> cables_;
  std::vector<std::unique_ptr<DriveWatch>> drives_;
  std::vector<std::unique_ptr<RtuCableWatch>> rtu_cables_;
  std::vector<std::unique_ptr<RtuDriveWatch>> rtu_drives_;
  std::vector<std::unique_ptr<CanCableWatch>> can_cables_;
  std::vector<std::unique_ptr<CanDriveWatch>> can_drives_;
  std::vector<Victim> victims_;
  std::vector<ClientAxis> axes_;
  std::unique_ptr<Nemesis> nemesis_;
  std::vector<std::unique_ptr<ModbusClient>> clients_;
};

}  // namespace axisgate::test
