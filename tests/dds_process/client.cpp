// SPDX-License-Identifier: Apache-2.0
// A DDS client in a process of its own, which a test can kill: DOMAIN STRENGTH LEASE_MS. Commands axis 1 each 20 ms.
#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/dds_process/peer.hpp"

int main(int argc, char** argv) {
  using namespace axisgate::dds::test;
  if (argc != 4) return 2;
  Peer peer(static_cast<std::uint32_t>(std::atoi(argv[1])));
  auto writer = peer.writer<axisgate::AxisCommand>("axisgate/axis_command",
                                                   {.strength = static_cast<std::uint32_t>(std::atoi(argv[2])),
                                                    .liveliness = Liveliness::manual_by_topic,
                                                    .lease = std::chrono::milliseconds(std::atoi(argv[3]))});
  axisgate::AxisCommand sample;
  sample.axis(1);
  for (std::uint64_t id = 1;; ++id) {
    sample.request_id(id);
    writer->write(sample);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}
