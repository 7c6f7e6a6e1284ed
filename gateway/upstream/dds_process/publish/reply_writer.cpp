// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/publish/reply_writer.hpp"

#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/dds_process/topics/writer_qos.hpp"

namespace axisgate::dds {

using eprosima::fastrtps::types::ReturnCode_t;

ReplyWriter::ReplyWriter(Participant& participant, const std::string& name, const fastdds::TypeSupport& type,
                         const GatewayId& gateway, program::Wake& wake)
    : gateway_(gateway),
      wake_(wake),
      writer_(participant.make_writer("axisgate/" + name, name, type, writer_qos(kRepliesKept, kMostInstances, false),
                                      {}, this)) {}

ReplyWriter::~ReplyWriter() { writer_.set_listener(nullptr); }

void ReplyWriter::write_held(SteadyNs now) {
  for (const Record& record : held_.take(now)) {
    if (const auto* reply = std::get_if<ReplyRecord>(&record)) write_now(*reply);
    if (const auto* object = std::get_if<ObjectReplyRecord>(&record)) write_now(*object);
  }
}

// The library bounds what it keeps by the number of instances alone, and an instance that was written once stays: with
// fewer than there are axis numbers, one that asks for many of them would take the others' replies away for good.
void ReplyWriter::make_room(std::uint16_t axis) {
  if (kept_ >= kMostRepliesKept) {
    const bool all_received = writer_.wait_for_acknowledgments({0, 0}) == ReturnCode_t::RETCODE_OK;
    std::size_t dropped = 0;
    if (!all_received) writer_.clear_history(&dropped);
    kept_of_.clear();
    kept_ = 0;
  }
  std::size_t& of_axis = kept_of_[axis];
  if (of_axis == kRepliesKept) return;
  ++of_axis;
  ++kept_;
}

void ReplyWriter::on_publication_matched(fastdds::DataWriter*, const fastdds::PublicationMatchedStatus& info) {
  const Guid reader = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.last_subscription_handle));
  if (info.current_count_change > 0) {
    held_.on_reader(reader, program::steady_now());
    wake_.set();
  } else {
    held_.on_reader_gone(reader);
  }
}

}  // namespace axisgate::dds
