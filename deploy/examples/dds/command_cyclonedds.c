// SPDX-License-Identifier: Apache-2.0
/* Commands one axis, with Eclipse Cyclone DDS: command_cyclonedds DOMAIN GATEWAY AXIS POSITION. Enables the axis, moves it
   to POSITION (rad or m) and keeps it until Ctrl-C; then disables it. GATEWAY is "" for a gateway without a name. */
#include <dds/dds.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axisgate.h"

static volatile sig_atomic_t ended = 0;
static dds_entity_t commands, heartbeats, replies;
static axisgate_Heartbeat heartbeat; /* its client is our writer of commands */
static axisgate_AxisCommand command;

static void on_signal(int number) {
  (void)number;
  ended = 1;
}

static uint32_t crc32(const char *text) { /* IEEE 802.3, as zlib's: the key of a gateway's name */
  uint32_t crc = 0xFFFFFFFF;
  for (; *text != '\0'; ++text)
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc ^ *text >> bit) & 1 ? 0xEDB88320 : 0);
  return ~crc;
}

/* What keeps the axis ours while we write nothing: either of the two would do. Without a sign of life it is stopped. */
static void beat(void) {
  ++heartbeat.counter;
  dds_write(heartbeats, &heartbeat);
  dds_assert_liveliness(commands);
  dds_sleepfor(DDS_MSECS(50));
}

/* Sends the command with a new id, and again with the same id until a reply comes: it is carried out once. The
   result: 2 done, 0 no reply. */
static int ask(uint8_t what, uint32_t mask) {
  ++command.request_id;
  command.command = what;
  command.mask = mask;
  for (int turn = 0; turn < 200; ++turn) {
    if (turn % 20 == 0) dds_write(commands, &command);
    beat();
    void *samples[1] = {NULL};
    dds_sample_info_t info;
    while (dds_take(replies, samples, &info, 1, 1) > 0) {
      const axisgate_CommandReply reply = *(const axisgate_CommandReply *)samples[0];
      dds_return_loan(replies, samples, 1);
      if (!info.valid_data || reply.request_id != command.request_id) continue;
      if (memcmp(reply.writer, heartbeat.client, sizeof reply.writer) != 0) continue;
      printf("command %u: result %u, detail 0x%x\n", what, reply.result, reply.detail);
      fflush(stdout);
      if (reply.result != 21) return reply.result;
      if (reply.detail >= 2) return (int)reply.detail; /* 21: its reply was lost, and this was its result */
    }
  }
  return printf("command %u: no reply\n", what), 0;
}

int main(int argc, char **argv) {
  if (argc != 5) return fputs("usage: command_cyclonedds DOMAIN GATEWAY AXIS POSITION\n", stderr), 64;
  signal(SIGINT, on_signal);
  const dds_entity_t participant = dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
  if (participant < 0) return fprintf(stderr, "no participant: see the README for CYCLONEDDS_URI\n"), 1;
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  replies = dds_create_reader(
      participant, dds_create_topic(participant, &axisgate_CommandReply_desc, "axisgate/command_reply", NULL, NULL), qos, NULL);
  dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
  dds_qset_ownership_strength(qos, 10); /* a stronger writer takes the axis, a weaker or equal one does not */
  dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_SECS(1));
  commands = dds_create_writer(
      participant, dds_create_topic(participant, &axisgate_AxisCommand_desc, "axisgate/axis_command", NULL, NULL), qos, NULL);
  dds_reset_qos(qos);
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  heartbeats = dds_create_writer(
      participant, dds_create_topic(participant, &axisgate_Heartbeat_desc, "axisgate/heartbeat", NULL, NULL), qos, NULL);
  dds_delete_qos(qos);
  dds_guid_t guid;
  if (replies < 0 || heartbeats < 0 || dds_get_guid(commands, &guid) < 0) return 1;
  memcpy(heartbeat.client, guid.v, sizeof guid.v);
  snprintf(command.gateway, sizeof command.gateway, "%s", argv[2]);
  command.gateway_key = crc32(argv[2]);
  command.axis = (uint16_t)atoi(argv[3]);
  command.target_position = atof(argv[4]);

  const int enabled = ask(1, 0);
  if (enabled == 7 || enabled >= 16) return 1; /* another client's: a disable of ours would stop that motor */
  const int moves = enabled == 2 && ask(6, axisgate_HAS_TARGET_POSITION) == 2;
  while (!ended && moves) beat(); /* the reply says that the move has begun; AxisState, where it is */
  const int good = ask(2, 0) == 2 && ask(13, 0) == 2;
  dds_delete(participant);
  return good ? 0 : 1;
}
