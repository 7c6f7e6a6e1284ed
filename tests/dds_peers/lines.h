// SPDX-License-Identifier: Apache-2.0
// The line protocol of the peers: words come in on stdin, one JSON object a line goes out on stdout.
// Promises that a line is written whole, whichever thread of a DDS library writes it.
// Never knows a DDS library: both peers share it.
//
//   reader TOPIC [volatile] [best_effort] [deadline MS] [automatic MS] [raw]
//                                 a reader; every sample and change of its status is told
//   writer TOPIC [strength N|shared] [automatic|participant|manual MS] [best_effort] [raw]
//                                 a writer with that liveliness; its GUID is told
//   write TOPIC MEMBER=VALUE...                                  a sample; members that are not named are 0
//   assert TOPIC, delete TOPIC                                   of the writer: its liveliness, its end
//   wherever TOPIC is one of several, such as the topics of ROS 2: KIND:NAME, the name as it is on the wire
//   tell WORD                     tells it: what was asked before is done
//   quit                          leaves the domain in good order, as at the end of stdin
//
// MS is the lease; automatic: the library renews it, manual: samples and `assert` do. raw (Fast DDS alone): the sample's
// CDR bytes as they are on the wire, written with `write TOPIC payload=HEX`.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { kMaxWords = 32, kMaxLine = 32 * 1024 };

struct Line {
  size_t count;
  char* words[kMaxWords];
  char text[kMaxLine];
};

/// The next line of stdin, blanks apart; false at its end. Words beyond kMaxWords are left out.
bool read_line(struct Line* line);
/// Word `index`, or "".
const char* word(const struct Line* line, size_t index);
bool has_word(const struct Line* line, const char* text);
/// The number behind this word, or `otherwise`.
long number_after(const struct Line* line, const char* text, long otherwise);
/// VALUE of the word MEMBER=VALUE, or "".
const char* value_of(const struct Line* line, const char* member);

bool value_flag(const struct Line* line, const char* member);
uint8_t value_u8(const struct Line* line, const char* member);
uint16_t value_u16(const struct Line* line, const char* member);
uint32_t value_u32(const struct Line* line, const char* member);
uint64_t value_u64(const struct Line* line, const char* member);
int16_t value_i16(const struct Line* line, const char* member);
double value_f64(const struct Line* line, const char* member);
/// The bytes of a value in hexadecimal digits: how many were put.
size_t value_hex(const struct Line* line, const char* member, uint8_t* bytes, size_t room);

/// The words between the commas of a value; they stay good as long as the line. How many were put.
size_t value_list(const struct Line* line, const char* member, char** words, size_t room);
/// What stands before the colon of a topic's word, into `kind`; the DDS name behind it, or NULL.
const char* topic_name(const char* topic, char* kind, size_t room);

/// Begins a line about a topic: {"on": "sample", "topic": "axis_state". It is this thread's alone until end_line().
void begin_line(const char* on, const char* topic);
void end_line(void);
void begin_object(const char* name);
void end_object(void);
void begin_list(const char* name);
void end_list(void);

/// An empty name: the value alone, as in a list.
void put_u64(const char* name, uint64_t value);
void put_i64(const char* name, int64_t value);
/// Infinities and NaN as Python's json reads them.
void put_f64(const char* name, double value);
void put_flag(const char* name, bool value);
void put_text(const char* name, const char* value);
void put_hex(const char* name, const uint8_t* bytes, size_t count);

#ifdef __cplusplus
}
#endif
