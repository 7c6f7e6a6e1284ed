// SPDX-License-Identifier: Apache-2.0
// What participants tell of their writers when they are discovered: who commands, and which other gateway has our key.
// Promises to note and wake, and no more. Never makes a reader.
#pragma once

#include "gateway/upstream/dds_process/discovery/namesake_watch.hpp"
#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"
#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

/// Hears of all writers of the domain; must be there before the participant is, and outlive it.
class WriterDiscovery : public fastdds::DomainParticipantListener {
 public:
  WriterDiscovery(WriterWatch& commanders, NamesakeWatch& namesakes, program::Wake& wake)
      : commanders_(commanders), namesakes_(namesakes), wake_(wake) {}
  void on_publisher_discovery(fastdds::DomainParticipant* participant,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;

 private:
  WriterWatch& commanders_;
  NamesakeWatch& namesakes_;
  program::Wake& wake_;
};

}  // namespace axisgate::dds
