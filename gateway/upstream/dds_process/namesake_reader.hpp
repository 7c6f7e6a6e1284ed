// SPDX-License-Identifier: Apache-2.0
// A reader of axis_state, there only while another participant has our gateway's key: what it hears proves that this
// one is no dead entry of a discovery server, and tells which axes it has. Promises to wait for nobody and to be heard
// by nobody: best effort. Never keeps a state.
#pragma once

#include "gateway/upstream/dds_process/namesake_watch.hpp"
#include "gateway/upstream/dds_process/participant.hpp"
#include "gateway/upstream/dds_process/wake.hpp"

namespace axisgate::dds {

class NamesakeReader : private fastdds::DataReaderListener {
 public:
  NamesakeReader(Participant& participant, NamesakeWatch& watch, Wake& wake);
  ~NamesakeReader() override;
  NamesakeReader(const NamesakeReader&) = delete;
  NamesakeReader& operator=(const NamesakeReader&) = delete;

  /// Begins or ends to read, as the watch wants it.
  void update();

 private:
  void on_data_available(fastdds::DataReader* reader) override;

  Participant& participant_;
  NamesakeWatch& watch_;
  Wake& wake_;
  fastdds::DataReader* reader_ = nullptr;
};

}  // namespace axisgate::dds
