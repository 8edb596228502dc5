/* The device's end of `zwidth rig --driver serial:PORT`, for any microcontroller: C99 and C++, no heap, no library.
 *
 *   zwidth_serial_t zwidth;
 *   zwidth_serial_begin(&zwidth, 2.0f, 100);              2 N or N m at most; no force 100 ms after the last one
 *   for (;;) {
 *     while (a byte has come) {
 *       if (zwidth_serial_receive(&zwidth, the byte, milliseconds)) {
 *         uint8_t out[ZWIDTH_SERIAL_MOST];
 *         write(out, zwidth_serial_answer(&zwidth, position, velocity, out));
 *       }
 *     }
 *     apply(zwidth_serial_force(&zwidth, 0.0f, milliseconds));
 *   }
 *
 * Positions in m or rad, forces in N or N m, of the device: gears and signs are the sketch's. There is no way to the force
 * but zwidth_serial_force(), which the watchdog stands in. All calls from one context (the loop, or one interrupt). What a
 * loop that hangs does, this file cannot know: switch the microcontroller's own watchdog on, too. Bytes: docs/rig_serial.md.
 */
#ifndef ZWIDTH_SERIAL_H
#define ZWIDTH_SERIAL_H

#include <stdint.h>
#include <string.h>

#define ZWIDTH_SERIAL_VERSION 1
#define ZWIDTH_SERIAL_MOST 20 /* bytes of an answer, its end included */
#define ZWIDTH_SERIAL_MOST_IN 10 /* bytes of what the host sends, without its end */

/* What the host is told; 16 to 255: a fault of the sketch's. */
enum {
  ZWIDTH_SERIAL_ALONE = 0,   /* no host has held the device since it started */
  ZWIDTH_SERIAL_HOLDING = 1, /* the host's forces act */
  ZWIDTH_SERIAL_LET_GO = 2,  /* the watchdog bit: no force until the host takes hold anew */
  ZWIDTH_SERIAL_RELEASED = 3 /* the host gave the device back: no force, either */
};

typedef struct {
  float force_limit;
  float wanted;  /* the host's last force */
  float applied; /* what zwidth_serial_force() said last */
  uint32_t fed;  /* ms: when the host's last force came */
  uint16_t watchdog;
  uint16_t times_let_go;
  uint16_t silence; /* ms from the last force to when the watchdog bit, of the last time */
  uint16_t last;    /* sequence of the last force that was taken */
  uint16_t asked;   /* sequence of the frame to answer */
  uint8_t kind;     /* of that */
  uint8_t state;
  uint8_t count; /* of the bytes that have come since the last frame's end; beyond the most: it is none */
  uint8_t bytes[ZWIDTH_SERIAL_MOST_IN];
} zwidth_serial_t;

/* `force_limit`, N or N m, more than 0: what is more is cut to it; one that is none lets no force through. `watchdog`, ms: 10 to
 * 1000. */
static inline void zwidth_serial_begin(zwidth_serial_t *zwidth, float force_limit, uint16_t watchdog) {
  memset(zwidth, 0, sizeof *zwidth);
  zwidth->force_limit = force_limit > 0.0f ? force_limit : 0.0f;
  zwidth->watchdog = watchdog;
}

/* ---- bytes: little-endian, CRC-16/MCRF4XX, then COBS and a 0 at the end ---- */

static inline uint16_t zwidth_serial_crc(const uint8_t *bytes, uint8_t count) {
  uint16_t crc = 0xffff;
  uint8_t i;
  for (i = 0; i < count; ++i) { /* a byte in one step, without a table; shifts that an AVR makes in few cycles */
    uint8_t x = (uint8_t)(bytes[i] ^ crc);
    x = (uint8_t)(x ^ (uint8_t)(x << 4));
    crc = (uint16_t)(((uint16_t)((uint16_t)x << 8) | (crc >> 8)) ^ (uint8_t)(x >> 4) ^ (uint16_t)((uint16_t)x << 3));
  }
  return crc;
}

static inline uint8_t *zwidth_serial_put16(uint8_t *to, uint16_t value) {
  to[0] = (uint8_t)value;
  to[1] = (uint8_t)(value >> 8);
  return to + 2;
}

static inline uint8_t *zwidth_serial_put_float(uint8_t *to, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  to = zwidth_serial_put16(to, (uint16_t)bits);
  return zwidth_serial_put16(to, (uint16_t)(bits >> 16));
}

static inline uint16_t zwidth_serial_get16(const uint8_t *from) {
  return (uint16_t)(from[0] | (uint16_t)(from[1] << 8));
}

static inline float zwidth_serial_get_float(const uint8_t *from) {
  const uint32_t bits = zwidth_serial_get16(from) | (uint32_t)zwidth_serial_get16(from + 2) << 16;
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* By its bits, for -ffast-math takes every number for one. */
static inline uint8_t zwidth_serial_is_finite(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return (bits & 0x7f800000u) != 0x7f800000u;
}

/* COBS: each 0 becomes the distance to the next one, so that a 0 is the end of a frame and nothing else. */
static inline uint8_t zwidth_serial_encode(const uint8_t *from, uint8_t count, uint8_t *to) {
  uint8_t code = 0, end = 1, i;
  for (i = 0; i < count; ++i) {
    if (from[i] != 0) {
      to[end++] = from[i];
    } else {
      to[code] = (uint8_t)(end - code);
      code = end++;
    }
  }
  to[code] = (uint8_t)(end - code);
  to[end++] = 0;
  return end;
}

/* The other way, in place: how many bytes there are; 0 where none were encoded so. */
static inline uint8_t zwidth_serial_decode(uint8_t *bytes, uint8_t count) {
  uint8_t from = 0, to = 0;
  while (from < count) {
    uint8_t code = bytes[from++];
    if (code == 0 || code - 1 > count - from) return 0;
    while (--code != 0) bytes[to++] = bytes[from++];
    if (from < count) bytes[to++] = 0;
  }
  return to;
}

/* ---- the watchdog ---- */

static inline void zwidth_serial_look(zwidth_serial_t *zwidth, uint32_t now) {
  const uint32_t silence = now - zwidth->fed; /* right, too, where the clock has begun anew at 0 */
  if (zwidth->state != ZWIDTH_SERIAL_HOLDING || silence <= zwidth->watchdog) return;
  zwidth->state = ZWIDTH_SERIAL_LET_GO;
  zwidth->wanted = 0.0f;
  zwidth->silence = silence < 0xffff ? (uint16_t)silence : 0xffff;
  ++zwidth->times_let_go;
}

/* Something is wrong with the device: 16 to 255, no force until it is told 0, and the host then takes hold anew. 0 where
 * nothing was wrong changes nothing. */
static inline void zwidth_serial_fail(zwidth_serial_t *zwidth, uint8_t fault) {
  if (fault == 0 && zwidth->state < 16) return;
  zwidth->state = fault == 0 ? ZWIDTH_SERIAL_RELEASED : fault < 16 ? 16 : fault;
}

/* The force to apply from now on, N or N m: the host's while it holds the device. `own` is that of a wall that runs on the
 * microcontroller itself (`zwidth export --format c`) until a host takes hold; 0.0f without one. Call it in each turn of the loop. */
static inline float zwidth_serial_force(zwidth_serial_t *zwidth, float own, uint32_t now) {
  float force = 0.0f;
  zwidth_serial_look(zwidth, now);
  if (zwidth->state == ZWIDTH_SERIAL_HOLDING) force = zwidth->wanted;
  if (zwidth->state == ZWIDTH_SERIAL_ALONE && zwidth_serial_is_finite(own)) force = own;
  if (force > zwidth->force_limit) force = zwidth->force_limit;
  if (force < -zwidth->force_limit) force = -zwidth->force_limit;
  return zwidth->applied = force;
}

/* ---- frames ---- */

/* A frame without its end. 1: it wants an answer. */
static inline uint8_t zwidth_serial_take(zwidth_serial_t *zwidth, uint32_t now) {
  uint8_t *const bytes = zwidth->bytes;
  const uint8_t count = zwidth->count > ZWIDTH_SERIAL_MOST_IN ? 0 : zwidth_serial_decode(bytes, zwidth->count);
  uint16_t sequence;
  if (count < 5 || zwidth_serial_get16(bytes + count - 2) != zwidth_serial_crc(bytes, (uint8_t)(count - 2))) return 0;
  sequence = zwidth_serial_get16(bytes + 1);
  if (bytes[0] == 'f') {
    const float force = count == 9 ? zwidth_serial_get_float(bytes + 3) : 0.0f;
    /* One that was sent before the last one, or twice, is out of date. */
    const uint8_t is_newer = (uint16_t)(sequence - zwidth->last - 1) < 0x7fff;
    if (count == 9 && zwidth->state == ZWIDTH_SERIAL_HOLDING && is_newer && zwidth_serial_is_finite(force)) {
      zwidth->wanted = force;
      zwidth->last = sequence;
      zwidth->fed = now;
    }
    return 0;
  }
  if (count != 5) return 0;
  if (bytes[0] == 'h' && zwidth->state < 16) {
    zwidth->state = ZWIDTH_SERIAL_HOLDING;
    zwidth->wanted = 0.0f;
    zwidth->last = sequence;
    zwidth->fed = now;
  } else if (bytes[0] == 'r' && zwidth->state < 16) {
    zwidth->state = ZWIDTH_SERIAL_RELEASED;
    zwidth->wanted = 0.0f;
  } else if (bytes[0] != 'q' && bytes[0] != 'd' && bytes[0] != 'h' && bytes[0] != 'r') {
    return 0;
  }
  zwidth->kind = bytes[0];
  zwidth->asked = sequence;
  return 1;
}

/* A byte has come from the host. `now`, ms, of a clock that begins anew at 2^32. 1: an answer is due, with the position of now. */
static inline uint8_t zwidth_serial_receive(zwidth_serial_t *zwidth, uint8_t byte, uint32_t now) {
  uint8_t is_asked;
  if (byte != 0) {
    if (zwidth->count < ZWIDTH_SERIAL_MOST_IN) zwidth->bytes[zwidth->count] = byte;
    if (zwidth->count <= ZWIDTH_SERIAL_MOST_IN) ++zwidth->count;
    return 0;
  }
  zwidth_serial_look(zwidth, now); /* before a force that came too late */
  is_asked = zwidth_serial_take(zwidth, now);
  zwidth->count = 0;
  return is_asked;
}

/* The answer that is due: its bytes and how many they are. `velocity` where it is known, 0 else. */
static inline uint8_t zwidth_serial_answer(const zwidth_serial_t *zwidth, float position, float velocity,
                                           uint8_t out[ZWIDTH_SERIAL_MOST]) {
  uint8_t bytes[ZWIDTH_SERIAL_MOST - 2];
  uint8_t *end = bytes;
  *end++ = zwidth->kind == 'd' ? 'D' : 'a';
  end = zwidth_serial_put16(end, zwidth->asked);
  *end++ = zwidth->state;
  if (zwidth->kind == 'd') {
    *end++ = ZWIDTH_SERIAL_VERSION;
    end = zwidth_serial_put16(end, zwidth->watchdog);
    end = zwidth_serial_put16(end, zwidth->times_let_go);
    end = zwidth_serial_put16(end, zwidth->silence);
    end = zwidth_serial_put_float(end, zwidth->force_limit);
  } else {
    end = zwidth_serial_put_float(end, position);
    end = zwidth_serial_put_float(end, velocity);
    end = zwidth_serial_put_float(end, zwidth->applied);
  }
  end = zwidth_serial_put16(end, zwidth_serial_crc(bytes, (uint8_t)(end - bytes)));
  return zwidth_serial_encode(bytes, (uint8_t)(end - bytes), out);
}

#endif
