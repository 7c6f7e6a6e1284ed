// SPDX-License-Identifier: Apache-2.0
/* Preloaded into a program: its wall clock shows as many seconds more as the file AXISGATE_WALL_CLOCK says (8 bytes). Its other clocks are
   those of the machine. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static volatile int64_t* more_seconds(void) {
  static volatile int64_t* more;
  if (more == NULL) {
    const int file = open(getenv("AXISGATE_WALL_CLOCK"), O_RDONLY | O_CLOEXEC);
    more = mmap(NULL, sizeof *more, PROT_READ, MAP_SHARED, file, 0);
    close(file);
  }
  return more;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int failed = (int)syscall(SYS_clock_gettime, clock, now);
  if (failed == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) now->tv_sec += *more_seconds();
  return failed;
}

time_t time(time_t* into) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (into != NULL) *into = now.tv_sec;
  return now.tv_sec;
}

int gettimeofday(struct timeval* restrict into, void* restrict zone) {
  struct timespec now;
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &now);
  into->tv_sec = now.tv_sec;
  into->tv_usec = now.tv_nsec / 1000;
  return 0;
}
