// SPDX-License-Identifier: Apache-2.0
// cyclone_peer DOMAIN [as_it_comes]: a DDS participant of Eclipse Cyclone DDS that does what lines.h says, on loopback alone,
// or as CYCLONEDDS_URI, if it is set, and the library's defaults have it.
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axisgate.h"
#include "lines.h"
#include "members.h"
#include "ros2_msgs.h"

// Without multicast: lo has no such flag unless somebody sets it. Asked for often, since a gateway's DDS process that is
// started anew tells only those whom it knows. A long lease of the participant: what is noticed earlier is noticed by what a
// writer states of itself.
static const char kDomain[] =
    "<General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces><AllowMulticast>false</AllowMulticast>"
    "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</MaxAutoParticipantIndex>"
    "<LeaseDuration>600s</LeaseDuration><SPDPInterval>500ms</SPDPInterval><Peers><Peer address='127.0.0.1'/></Peers></Discovery>";

enum { kMaxTaken = 64 };

static dds_entity_t participant;

static dds_entity_t checked(const char* what, dds_entity_t result) {
  if (result >= 0) return result;
  fprintf(stderr, "cyclone_peer: %s: %s\n", what, dds_strretcode(-result));
  exit(1);
}

// --- Samples as text -------------------------------------------------------------------------------------------------

static void put_stamp(const char* name, int64_t sec, uint32_t nanosec) {
  begin_object(name);
  put_i64("sec", sec);
  put_u64("nanosec", nanosec);
  end_object();
}

static void put_time(const char* name, axisgate_Time time) { put_stamp(name, time.sec, time.nanosec); }
static void put_guid(const char* name, const uint8_t* guid) { put_hex(name, guid, 16); }
static void put_bytes(const char* name, dds_sequence_octet data) { put_hex(name, data._buffer, data._length); }

#define PUT(kind, member) put_##kind(#member, s->member);

static void put_buses(const char* name, dds_sequence_axisgate_BusState buses) {
  begin_list(name);
  for (uint32_t i = 0; i < buses._length; ++i) {
    const axisgate_BusState* s = &buses._buffer[i];
    begin_object("");
    BUS_STATE_MEMBERS(PUT)
    end_object();
  }
  end_list();
}

static void put_header(const char* name, std_msgs_msg_dds__Header_ header) {
  begin_object(name);
  put_stamp("stamp", header.stamp.sec, header.stamp.nanosec);
  put_text("frame_id", header.frame_id);
  end_object();
}

static void put_texts(const char* name, dds_sequence_string texts) {
  begin_list(name);
  for (uint32_t i = 0; i < texts._length; ++i) put_text("", texts._buffer[i]);
  end_list();
}

static void put_numbers(const char* name, dds_sequence_double numbers) {
  begin_list(name);
  for (uint32_t i = 0; i < numbers._length; ++i) put_f64("", numbers._buffer[i]);
  end_list();
}

static void put_pairs(const char* name, dds_sequence_diagnostic_msgs_msg_dds__KeyValue_ pairs) {
  begin_list(name);
  for (uint32_t i = 0; i < pairs._length; ++i) {
    const diagnostic_msgs_msg_dds__KeyValue_* s = &pairs._buffer[i];
    begin_object("");
    KEY_VALUE_MEMBERS(PUT)
    end_object();
  }
  end_list();
}

static void put_statuses(const char* name, dds_sequence_diagnostic_msgs_msg_dds__DiagnosticStatus_ statuses) {
  begin_list(name);
  for (uint32_t i = 0; i < statuses._length; ++i) {
    const diagnostic_msgs_msg_dds__DiagnosticStatus_* s = &statuses._buffer[i];
    begin_object("");
    DIAGNOSTIC_STATUS_MEMBERS(PUT)
    end_object();
  }
  end_list();
}

#define SHOW(function, type, members)           \
  static void function(const void* sample) {    \
    const type* s = sample;                     \
    members(PUT)                                \
  }
SHOW(show_axis_state, axisgate_AxisState, AXIS_STATE_MEMBERS)
SHOW(show_axis_event, axisgate_AxisEvent, AXIS_EVENT_MEMBERS)
SHOW(show_gateway_state, axisgate_GatewayState, GATEWAY_STATE_MEMBERS)
SHOW(show_command_reply, axisgate_CommandReply, COMMAND_REPLY_MEMBERS)
SHOW(show_object_reply, axisgate_ObjectReply, OBJECT_REPLY_MEMBERS)
SHOW(show_diagnostics, diagnostic_msgs_msg_dds__DiagnosticArray_, DIAGNOSTIC_ARRAY_MEMBERS)
SHOW(show_joint_states, sensor_msgs_msg_dds__JointState_, JOINT_STATE_MEMBERS)

// --- Samples from text -----------------------------------------------------------------------------------------------

static dds_sequence_octet value_bytes(const struct Line* line, const char* member) {
  static uint8_t bytes[kMaxLine / 2];
  const size_t count = value_hex(line, member, bytes, sizeof bytes);
  const dds_sequence_octet sequence = {(uint32_t)count, (uint32_t)count, bytes, false};
  return sequence;
}

enum { kMaxJoints = 600 };

static std_msgs_msg_dds__Header_ value_header(const struct Line* line, const char* member) {
  (void)line;
  (void)member;
  static char nothing[] = "";
  const std_msgs_msg_dds__Header_ header = {{0, 0}, nothing};
  return header;
}

static dds_sequence_string value_texts(const struct Line* line, const char* member) {
  static char* words[kMaxJoints];
  const size_t count = value_list(line, member, words, kMaxJoints);
  const dds_sequence_string sequence = {(uint32_t)count, (uint32_t)count, words, false};
  return sequence;
}

// Three lists of numbers stand in one sample.
static dds_sequence_double value_numbers(const struct Line* line, const char* member) {
  static double numbers[3][kMaxJoints];
  static int turn;
  double* const to = numbers[turn++ % 3];
  char* words[kMaxJoints];
  const size_t count = value_list(line, member, words, kMaxJoints);
  for (size_t i = 0; i < count; ++i) to[i] = strtod(words[i], NULL);
  const dds_sequence_double sequence = {(uint32_t)count, (uint32_t)count, to, false};
  return sequence;
}

#define TAKE(kind, member) s->member = value_##kind(line, #member);
#define FILL(function, type, members)                                \
  static void function(const struct Line* line, void* sample) {      \
    type* s = sample;                                                \
    members(TAKE)                                                    \
  }
FILL(fill_command, axisgate_AxisCommand, AXIS_COMMAND_MEMBERS)
FILL(fill_joint_commands, sensor_msgs_msg_dds__JointState_, JOINT_STATE_MEMBERS)
FILL(fill_flag, std_msgs_msg_dds__Bool_, BOOL_MEMBERS)
FILL(fill_signal, std_msgs_msg_dds__Empty_, EMPTY_MEMBERS)
FILL(fill_request, axisgate_ObjectRequest, OBJECT_REQUEST_MEMBERS)
FILL(fill_counters, axisgate_Heartbeat, HEARTBEAT_MEMBERS)

static void fill_axis_command(const struct Line* line, void* sample) {
  axisgate_AxisCommand* s = sample;
  fill_command(line, s);
  snprintf(s->gateway, sizeof s->gateway, "%s", value_of(line, "gateway"));
}

static void fill_object_request(const struct Line* line, void* sample) {
  axisgate_ObjectRequest* s = sample;
  fill_request(line, s);
  snprintf(s->gateway, sizeof s->gateway, "%s", value_of(line, "gateway"));
}

static void fill_heartbeat(const struct Line* line, void* sample) {
  axisgate_Heartbeat* s = sample;
  fill_counters(line, s);
  value_hex(line, "client", s->client, sizeof s->client);
}

// --- Topics ----------------------------------------------------------------------------------------------------------

struct Topic {
  const char* word;
  const char* name;
  const dds_topic_descriptor_t* type;
  void (*show)(const void* sample);
  void (*fill)(const struct Line* line, void* sample);
  dds_entity_t topic;
  dds_entity_t writer;
};

enum { kMaxTopics = 64 };

/// Those that a line names by KIND:NAME stand behind those that are named here.
static struct Topic topics[kMaxTopics] = {
    {"axis_state", "axisgate/axis_state", &axisgate_AxisState_desc, show_axis_state, NULL, 0, 0},
    {"axis_event", "axisgate/axis_event", &axisgate_AxisEvent_desc, show_axis_event, NULL, 0, 0},
    {"gateway_state", "axisgate/gateway_state", &axisgate_GatewayState_desc, show_gateway_state, NULL, 0, 0},
    {"command_reply", "axisgate/command_reply", &axisgate_CommandReply_desc, show_command_reply, NULL, 0, 0},
    {"object_reply", "axisgate/object_reply", &axisgate_ObjectReply_desc, show_object_reply, NULL, 0, 0},
    {"joint_states", "rt/joint_states", &sensor_msgs_msg_dds__JointState__desc, show_joint_states, NULL, 0, 0},
    {"joint_commands", "rt/joint_commands", &sensor_msgs_msg_dds__JointState__desc, NULL, fill_joint_commands, 0, 0},
    {"diagnostics", "rt/diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc, show_diagnostics, NULL, 0, 0},
    {"flag", "", &std_msgs_msg_dds__Bool__desc, NULL, fill_flag, 0, 0},
    {"signal", "", &std_msgs_msg_dds__Empty__desc, NULL, fill_signal, 0, 0},
    {"heartbeat", "axisgate/heartbeat", &axisgate_Heartbeat_desc, NULL, fill_heartbeat, 0, 0},
    {"axis_command", "axisgate/axis_command", &axisgate_AxisCommand_desc, NULL, fill_axis_command, 0, 0},
    {"object_request", "axisgate/object_request", &axisgate_ObjectRequest_desc, NULL, fill_object_request, 0, 0},
};

static struct Topic* find_topic(const char* name) {
  for (size_t i = 0; i < kMaxTopics && topics[i].word != NULL; ++i)
    if (strcmp(topics[i].word, name) == 0) return &topics[i];
  return NULL;
}

static struct Topic* add_topic(const char* name) {
  static char kind[kMaxLine];
  const char* on_the_wire = topic_name(name, kind, sizeof kind);
  const struct Topic* like = find_topic(kind);
  size_t end = 0;
  while (end < kMaxTopics && topics[end].word != NULL) ++end;
  if (like == NULL || on_the_wire == NULL || end == kMaxTopics) {
    fprintf(stderr, "cyclone_peer: no topic '%s'\n", name);
    exit(1);
  }
  topics[end] = *like;
  topics[end].topic = topics[end].writer = 0;
  topics[end].word = strdup(name);
  topics[end].name = strchr(topics[end].word, ':') + 1;
  return &topics[end];
}

static struct Topic* topic_of(const char* name) {
  struct Topic* topic = find_topic(name);
  if (topic == NULL) topic = add_topic(name);
  if (topic->topic == 0) topic->topic = checked(name, dds_create_topic(participant, topic->type, topic->name, NULL, NULL));
  return topic;
}

static const char* state_text(dds_instance_state_t state) {
  if (state == DDS_IST_ALIVE) return "alive";
  return state == DDS_IST_NOT_ALIVE_DISPOSED ? "disposed" : "no_writers";
}

static void on_data_available(dds_entity_t reader, void* arg) {
  const struct Topic* topic = arg;
  void* samples[kMaxTaken] = {NULL};
  dds_sample_info_t infos[kMaxTaken];
  int32_t count;
  while ((count = dds_take(reader, samples, infos, kMaxTaken, kMaxTaken)) > 0) {
    for (int32_t i = 0; i < count; ++i) {
      begin_line(infos[i].valid_data ? "sample" : "instance", topic->word);
      put_text("state", state_text(infos[i].instance_state));
      if (infos[i].valid_data) {
        begin_object("data");
        topic->show(samples[i]);
        end_object();
      }
      end_line();
    }
    dds_return_loan(reader, samples, count);
  }
}

static void tell_count(const char* on, const void* topic, const char* name, uint64_t count) {
  begin_line(on, ((const struct Topic*)topic)->word);
  put_u64(name, count);
  end_line();
}

static void on_subscription_matched(dds_entity_t reader, const dds_subscription_matched_status_t status, void* arg) {
  (void)reader;
  tell_count("matched", arg, "count", status.current_count);
}

static void on_publication_matched(dds_entity_t writer, const dds_publication_matched_status_t status, void* arg) {
  (void)writer;
  tell_count("matched", arg, "count", status.current_count);
}

static void on_deadline_missed(dds_entity_t reader, const dds_requested_deadline_missed_status_t status, void* arg) {
  (void)reader;
  tell_count("deadline_missed", arg, "count", status.total_count);
}

static void on_liveliness_changed(dds_entity_t reader, const dds_liveliness_changed_status_t status, void* arg) {
  (void)reader;
  tell_count("liveliness", arg, "alive", status.alive_count);
}

static void on_liveliness_lost(dds_entity_t writer, const dds_liveliness_lost_status_t status, void* arg) {
  (void)writer;
  tell_count("liveliness_lost", arg, "count", status.total_count);
}

static void on_requested_incompatible(dds_entity_t reader, const dds_requested_incompatible_qos_status_t status,
                                      void* arg) {
  (void)reader;
  tell_count("incompatible", arg, "policy", status.last_policy_id);
}

static void on_offered_incompatible(dds_entity_t writer, const dds_offered_incompatible_qos_status_t status,
                                    void* arg) {
  (void)writer;
  tell_count("incompatible", arg, "policy", status.last_policy_id);
}

static dds_reliability_kind_t reliability_of(const struct Line* line) {
  return has_word(line, "best_effort") ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE;
}

static void make_reader(const struct Line* line) {
  struct Topic* topic = topic_of(word(line, 1));
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, reliability_of(line), DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  const bool kept = topic->show == show_axis_state || topic->show == show_axis_event || topic->show == show_gateway_state;
  dds_qset_durability(qos, kept && !has_word(line, "volatile") ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  if (has_word(line, "deadline")) dds_qset_deadline(qos, DDS_MSECS(number_after(line, "deadline", 0)));
  if (has_word(line, "automatic"))
    dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(number_after(line, "automatic", 0)));
  dds_listener_t* listener = dds_create_listener(topic);
  dds_lset_data_available(listener, on_data_available);
  dds_lset_subscription_matched(listener, on_subscription_matched);
  dds_lset_requested_deadline_missed(listener, on_deadline_missed);
  dds_lset_liveliness_changed(listener, on_liveliness_changed);
  dds_lset_requested_incompatible_qos(listener, on_requested_incompatible);
  checked("reader", dds_create_reader(participant, topic->topic, qos, listener));
  dds_delete_listener(listener);
  dds_delete_qos(qos);
}

static void make_writer(const struct Line* line) {
  struct Topic* topic = topic_of(word(line, 1));
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, topic->fill == fill_heartbeat ? DDS_RELIABILITY_BEST_EFFORT : reliability_of(line), DDS_SECS(10));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  dds_qset_writer_data_lifecycle(qos, false);
  if (topic->fill == fill_axis_command && !has_word(line, "shared")) {
    dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
    dds_qset_ownership_strength(qos, (int32_t)number_after(line, "strength", 0));
  }
  if (has_word(line, "automatic"))
    dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(number_after(line, "automatic", 0)));
  if (has_word(line, "participant"))
    dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_PARTICIPANT, DDS_MSECS(number_after(line, "participant", 0)));
  if (has_word(line, "manual"))
    dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_MSECS(number_after(line, "manual", 0)));
  dds_listener_t* listener = dds_create_listener(topic);
  dds_lset_publication_matched(listener, on_publication_matched);
  dds_lset_liveliness_lost(listener, on_liveliness_lost);
  dds_lset_offered_incompatible_qos(listener, on_offered_incompatible);
  topic->writer = checked("writer", dds_create_writer(participant, topic->topic, qos, listener));
  dds_delete_listener(listener);
  dds_delete_qos(qos);
  dds_guid_t guid;
  checked("guid", dds_get_guid(topic->writer, &guid));
  begin_line("writer", topic->word);
  put_hex("guid", guid.v, sizeof guid.v);
  end_line();
}

static void write_sample(const struct Line* line) {
  struct Topic* topic = topic_of(word(line, 1));
  static union {
    axisgate_AxisCommand command;
    axisgate_ObjectRequest request;
    axisgate_Heartbeat heartbeat;
    sensor_msgs_msg_dds__JointState_ joints;
    std_msgs_msg_dds__Bool_ flag;
    std_msgs_msg_dds__Empty_ nothing;
  } sample;
  topic->fill(line, &sample);
  const bool last = strcmp(word(line, 0), "writedispose") == 0;
  checked("write", last ? dds_writedispose(topic->writer, &sample) : dds_write(topic->writer, &sample));
}

static void delete_writer(const struct Line* line) {
  struct Topic* topic = topic_of(word(line, 1));
  checked("delete", dds_delete(topic->writer));
  topic->writer = 0;
}

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    fputs("usage: cyclone_peer DOMAIN [as_it_comes]\n", stderr);
    return 2;
  }
  const dds_domainid_t domain = (dds_domainid_t)strtoul(argv[1], NULL, 10);
  const dds_entity_t whole = argc == 3 ? 0 : checked("domain", dds_create_domain(domain, kDomain));
  participant = checked("participant", dds_create_participant(domain, NULL, NULL));
  begin_line("ready", "");
  end_line();
  static struct Line line;
  while (read_line(&line) && strcmp(word(&line, 0), "quit") != 0) {
    if (strcmp(word(&line, 0), "reader") == 0)
      make_reader(&line);
    else if (strcmp(word(&line, 0), "writer") == 0)
      make_writer(&line);
    else if (strcmp(word(&line, 0), "write") == 0 || strcmp(word(&line, 0), "writedispose") == 0)
      write_sample(&line);
    else if (strcmp(word(&line, 0), "assert") == 0)
      checked("assert", dds_assert_liveliness(topic_of(word(&line, 1))->writer));
    else if (strcmp(word(&line, 0), "delete") == 0)
      delete_writer(&line);
    else if (strcmp(word(&line, 0), "tell") == 0) {
      begin_line("told", word(&line, 1));
      end_line();
    } else
      fprintf(stderr, "cyclone_peer: what is '%s'?\n", word(&line, 0));
  }
  checked("end", dds_delete(whole != 0 ? whole : participant));
  return 0;
}
