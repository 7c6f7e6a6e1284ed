// SPDX-License-Identifier: Apache-2.0
/* Prints each state of each axis, with Eclipse Cyclone DDS: axes_cyclonedds [DOMAIN]. Ends with Ctrl-C. */
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>

#include "axisgate.h"

enum { kMostSamples = 64 };

int main(int argc, char **argv) {
  const dds_domainid_t domain = (dds_domainid_t)(argc > 1 ? atoi(argv[1]) : 0);
  const dds_entity_t participant = dds_create_participant(domain, NULL, NULL);
  const dds_entity_t topic =
      dds_create_topic(participant, &axisgate_AxisState_desc, "axisgate/axis_state", NULL, NULL);

  /* Reliable and transient-local: the last state of every axis comes at once. */
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  if (participant < 0 || topic < 0 || reader < 0) {
    fprintf(stderr, "no participant, topic or reader: see the README for CYCLONEDDS_URI\n");
    return 1;
  }

  const dds_entity_t waitset = dds_create_waitset(participant);
  dds_waitset_attach(waitset, dds_create_readcondition(reader, DDS_ANY_STATE), reader);
  for (;;) {
    dds_waitset_wait(waitset, NULL, 0, DDS_INFINITY);
    void *samples[kMostSamples] = {NULL};
    dds_sample_info_t infos[kMostSamples];
    const dds_return_t count = dds_take(reader, samples, infos, kMostSamples, kMostSamples);
    for (dds_return_t i = 0; i < count; ++i) {
      const axisgate_AxisState *axis = samples[i];
      if (!infos[i].valid_data) continue;
      /* link_state 2 is online; a value is good while its bit in `valid` is 1 (bit 2: position, bit 3: velocity). */
      printf("%s axis %u %s  link %u  statusword %04x  position %.4f%s  velocity %.4f%s  error %04x\n", axis->gateway,
             axis->axis, axis->name, axis->link_state, axis->statusword, axis->position, (axis->valid & 4) != 0 ? "" : "?",
             axis->velocity, (axis->valid & 8) != 0 ? "" : "?", axis->error_code);
    }
    fflush(stdout);
    if (count > 0) dds_return_loan(reader, samples, count);
  }
}
