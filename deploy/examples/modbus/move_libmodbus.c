// SPDX-License-Identifier: Apache-2.0
/* Moves one axis and lets it go again, with libmodbus: move_libmodbus HOST PORT AXIS TURNS RPM

   Enables it, moves it to TURNS, waits until it is there, disables it. Ctrl-C and SIGTERM stop it before the program
   ends; if the program dies, or its network does, the gateway stops it when the lease has run out. Debian: apt install
   gcc libmodbus-dev; gcc -O2 -o move_libmodbus move_libmodbus.c $(pkg-config --cflags --libs libmodbus) -lm */
#include <errno.h>
#include <math.h>
#include <modbus.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Offsets in the block of an axis, which begins at 100 * axis (schemas/register-map.md). */
enum {
  LINK_STATE = 18,
  RESULT = 25,
  ID_SEEN = 30,
  MOTION_STATE = 32,
  TARGET_POSITION = 42,
  PROFILE_VELOCITY = 48,
  COMMAND = 54,
  UNITS_PER_REV = 90
};
enum { ENABLE = 1, DISABLE = 2, QUICK_STOP = 3, MOVE_ABSOLUTE = 6, RELEASE = 13 };
enum { ONLINE = 2, ACTIVE = 1, COMPLETED = 2 };

static modbus_t* gateway;
static int first;
static uint16_t id;
static volatile sig_atomic_t ended = 0;

static void on_signal(int number) {
  (void)number;
  ended = 1;
}

static int get(int offset, int count, uint16_t* words) {
  if (modbus_read_registers(gateway, first + offset, count, words) == count) return 1;
  return fprintf(stderr, "reading offset %d: %s\n", offset, modbus_strerror(errno)), 0;
}

/* The answer comes when the drive has acknowledged, so what follows can rely on it. */
static int put(int offset, int count, const uint16_t* words) {
  if (modbus_write_registers(gateway, first + offset, count, words) == count) return 1;
  fprintf(stderr, "writing offset %d: %s", offset, modbus_strerror(errno));
  uint16_t result[3];
  if (get(RESULT, 3, result)) fprintf(stderr, "; result %u, detail 0x%04x%04x", result[0], result[1], result[2]);
  return fputs("\n", stderr), 0;
}

static int put32(int offset, int32_t value) { /* high word first, both in one request */
  const uint16_t words[2] = {(uint16_t)((uint32_t)value >> 16), (uint16_t)value};
  return put(offset, 2, words);
}

/* A new id is a new command; the same request sent twice is carried out once. */
static int command(uint16_t number) {
  id = (uint16_t)(id % 0xFFFF + 1); /* 1 to 65535; 0 is no id */
  const uint16_t words[2] = {number, id};
  return put(COMMAND, 2, words);
}

static int move(double turns, double rpm) {
  uint16_t units[4], motion[2] = {0, 0};
  if (!command(ENABLE) || !get(UNITS_PER_REV, 4, units)) return 0;
  const double per_turn = ((double)units[0] * 65536 + units[1]) / ((double)units[2] * 65536 + units[3]);
  if (!put32(PROFILE_VELOCITY, (int32_t)lround(rpm * 1000)) ||
      !put32(TARGET_POSITION, (int32_t)lround(turns * per_turn)))
    return 0;
  if (!command(MOVE_ABSOLUTE)) return 0;
  printf("moving to %g turns\n", turns), fflush(stdout);
  /* Each read is a sign of life: without one for the time of the lease (2 s) the gateway stops the axis. */
  while (!ended && (motion[1] != id || motion[0] == ACTIVE)) {
    usleep(100000);
    if (!get(MOTION_STATE, 2, motion)) return 0;
  }
  if (ended) return puts("stopping"), 0;
  puts(motion[0] == COMPLETED ? "there" : "the move has failed");
  return motion[0] == COMPLETED;
}

int main(int argc, char** argv) {
  if (argc != 6) return fputs("usage: move_libmodbus HOST PORT AXIS TURNS RPM\n", stderr), 64;
  signal(SIGINT, on_signal), signal(SIGTERM, on_signal);
  first = 100 * atoi(argv[3]);
  gateway = modbus_new_tcp(argv[1], atoi(argv[2]));
  if (gateway == NULL || modbus_set_response_timeout(gateway, 5, 0) != 0 || modbus_connect(gateway) != 0)
    return fprintf(stderr, "no gateway at %s:%s: %s\n", argv[1], argv[2], modbus_strerror(errno)), 1;
  /* A program begins by writing command 0, which asks for nothing, with an id that it will not use next. */
  uint16_t link, begin[2] = {0, 0};
  if (!get(LINK_STATE, 1, &link) || !get(ID_SEEN, 1, &id)) return 1;
  if (link != ONLINE) return fprintf(stderr, "axis %s is not online\n", argv[3]), 1;
  begin[1] = id = (uint16_t)(id % 0xFFFF + 1);
  if (!put(COMMAND, 2, begin)) return 1;

  int good = move(atof(argv[4]), atof(argv[5]));
  if (!good) command(QUICK_STOP);
  good = command(DISABLE) && good;
  good = command(RELEASE) && good; /* others need not wait for the end of the lease */
  modbus_close(gateway);
  modbus_free(gateway);
  return good ? 0 : 1;
}
