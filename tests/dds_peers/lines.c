// SPDX-License-Identifier: Apache-2.0
#include "lines.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static pthread_mutex_t writing = PTHREAD_MUTEX_INITIALIZER;
static bool first;  // in its object or list

bool read_line(struct Line* line) {
  line->count = 0;
  if (fgets(line->text, sizeof line->text, stdin) == NULL) return false;
  char* rest = NULL;
  for (char* next = strtok_r(line->text, " \n", &rest); next != NULL && line->count < kMaxWords;
       next = strtok_r(NULL, " \n", &rest))
    line->words[line->count++] = next;
  return true;
}

const char* word(const struct Line* line, size_t index) { return index < line->count ? line->words[index] : ""; }

static size_t find(const struct Line* line, const char* text) {
  size_t at = 0;
  while (at < line->count && strcmp(line->words[at], text) != 0) ++at;
  return at;
}

bool has_word(const struct Line* line, const char* text) { return find(line, text) < line->count; }

long number_after(const struct Line* line, const char* text, long otherwise) {
  const size_t at = find(line, text);
  return at + 1 < line->count ? strtol(line->words[at + 1], NULL, 0) : otherwise;
}

const char* value_of(const struct Line* line, const char* member) {
  const size_t length = strlen(member);
  for (size_t i = 0; i < line->count; ++i)
    if (strncmp(line->words[i], member, length) == 0 && line->words[i][length] == '=')
      return line->words[i] + length + 1;
  return "";
}

bool value_flag(const struct Line* line, const char* member) { return value_u64(line, member) != 0; }
uint8_t value_u8(const struct Line* line, const char* member) { return (uint8_t)value_u64(line, member); }
uint16_t value_u16(const struct Line* line, const char* member) { return (uint16_t)value_u64(line, member); }
uint32_t value_u32(const struct Line* line, const char* member) { return (uint32_t)value_u64(line, member); }
uint64_t value_u64(const struct Line* line, const char* member) { return strtoull(value_of(line, member), NULL, 0); }

int16_t value_i16(const struct Line* line, const char* member) {
  return (int16_t)strtol(value_of(line, member), NULL, 0);
}

double value_f64(const struct Line* line, const char* member) { return strtod(value_of(line, member), NULL); }

size_t value_hex(const struct Line* line, const char* member, uint8_t* bytes, size_t room) {
  const char* digits = value_of(line, member);
  size_t count = 0;
  unsigned int byte = 0;
  while (count < room && sscanf(digits, "%2x", &byte) == 1) {
    bytes[count++] = (uint8_t)byte;
    digits += 2;
  }
  return count;
}

size_t value_list(const struct Line* line, const char* member, char** words, size_t room) {
  size_t count = 0;
  char* next = (char*)(uintptr_t)value_of(line, member);  // it points into line->text
  while (*next != '\0' && count < room) {
    words[count++] = next;
    next += strcspn(next, ",");
    if (*next == ',') *next++ = '\0';
  }
  return count;
}

const char* topic_name(const char* topic, char* kind, size_t room) {
  const size_t length = strcspn(topic, ":");
  snprintf(kind, room, "%.*s", (int)length, topic);
  return topic[length] == ':' ? topic + length + 1 : NULL;
}

static void name_it(const char* name) {
  if (!first) fputs(", ", stdout);
  first = false;
  if (*name != '\0') printf("\"%s\": ", name);
}

static void quote(const char* value) {
  putchar('"');
  for (; *value != '\0'; ++value) {
    const unsigned char c = (unsigned char)*value;
    if (c < 0x20)
      printf("\\u%04x", c);
    else if (c == '"' || c == '\\')
      printf("\\%c", c);
    else
      putchar(c);
  }
  putchar('"');
}

void begin_line(const char* on, const char* topic) {
  pthread_mutex_lock(&writing);
  putchar('{');
  first = true;
  put_text("on", on);
  put_text("topic", topic);
}

void end_line(void) {
  puts("}");
  fflush(stdout);
  pthread_mutex_unlock(&writing);
}

void begin_object(const char* name) {
  name_it(name);
  putchar('{');
  first = true;
}

void end_object(void) {
  putchar('}');
  first = false;
}

void begin_list(const char* name) {
  name_it(name);
  putchar('[');
  first = true;
}

void end_list(void) {
  putchar(']');
  first = false;
}

void put_u64(const char* name, uint64_t value) {
  name_it(name);
  printf("%llu", (unsigned long long)value);
}

void put_i64(const char* name, int64_t value) {
  name_it(name);
  printf("%lld", (long long)value);
}

void put_f64(const char* name, double value) {
  name_it(name);
  if (isnan(value))
    fputs("NaN", stdout);
  else if (isinf(value))
    fputs(value > 0 ? "Infinity" : "-Infinity", stdout);
  else
    printf("%.17g", value);
}

void put_flag(const char* name, bool value) {
  name_it(name);
  fputs(value ? "true" : "false", stdout);
}

void put_text(const char* name, const char* value) {
  name_it(name);
  quote(value);
}

void put_hex(const char* name, const uint8_t* bytes, size_t count) {
  name_it(name);
  putchar('"');
  for (size_t i = 0; i < count; ++i) printf("%02x", bytes[i]);
  putchar('"');
}
