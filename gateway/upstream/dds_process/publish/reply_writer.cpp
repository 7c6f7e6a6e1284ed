// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/publish/reply_writer.hpp"

#include "gateway/upstream/dds_process/topics/command_topics.hpp"

namespace axisgate::dds {

ReplyWriter::ReplyWriter(Participant& participant, const std::string& name, const fastdds::TypeSupport& type,
                         const fastdds::DataWriterQos& qos, const GatewayId& gateway, Wake& wake)
    : gateway_(gateway), wake_(wake), writer_(participant.make_writer("axisgate/" + name, name, type, qos, {}, this)) {}

ReplyWriter::~ReplyWriter() { writer_.set_listener(nullptr); }

void ReplyWriter::write_held(SteadyNs now) {
  for (const Record& record : held_.take(now)) {
    if (const auto* reply = std::get_if<ReplyRecord>(&record)) write_now(*reply);
    if (const auto* object = std::get_if<ObjectReplyRecord>(&record)) write_now(*object);
  }
}

void ReplyWriter::on_publication_matched(fastdds::DataWriter*, const fastdds::PublicationMatchedStatus& info) {
  const Guid reader = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.last_subscription_handle));
  if (info.current_count_change > 0) {
    held_.on_reader(reader, steady_now());
    wake_.set();
  } else {
    held_.on_reader_gone(reader);
  }
}

}  // namespace axisgate::dds
