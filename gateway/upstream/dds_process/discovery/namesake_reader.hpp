// SPDX-License-Identifier: Apache-2.0
// A reader of axis_state, there only while another participant has our gateway's key: what it hears proves that this
// one is no dead entry of a discovery server, and tells which axes it has. Such a server tells participants of those
// alone whom they read, so behind one there is a reader of gateway_state as well, one sample a second and gateway.
// Promises that the last state of an axis is heard, which says once that the axis was given up: reliable. A writer of
// states keeps the newest one of each axis, and waits for no reader. Never keeps a state.
#pragma once

#include "gateway/upstream/dds_process/discovery/namesake_watch.hpp"
#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

class NamesakeReader : private fastdds::DataReaderListener {
 public:
  NamesakeReader(Participant& participant, bool behind_a_server, NamesakeWatch& watch, program::Wake& wake);
  ~NamesakeReader() override;
  NamesakeReader(const NamesakeReader&) = delete;
  NamesakeReader& operator=(const NamesakeReader&) = delete;

  /// Begins or ends to read, as the watch wants it.
  void update();

 private:
  void on_data_available(fastdds::DataReader* reader) override;
  void on_subscription_matched(fastdds::DataReader* reader, const fastdds::SubscriptionMatchedStatus& info) override;
  template <typename Sample, typename Heard>
  void take_all(fastdds::DataReader& reader, const Heard& heard);

  Participant& participant_;
  NamesakeWatch& watch_;
  program::Wake& wake_;
  fastdds::DataReader* reader_ = nullptr;
  fastdds::DataReader* gateways_ = nullptr;  ///< behind a discovery server
};

}  // namespace axisgate::dds
