/* The drive's end of `zwidth rig --driver udp:HOST:PORT` in C99, around two functions of a device: udp_drive.c simulates one,
 * bridges/ asks those of vendors. Frames: docs/rig_drives.md.
 *
 * Prints its port, and then a line each time its watchdog lets go or takes hold again.
 */
#ifndef ZWIDTH_UDP_DRIVE_H
#define ZWIDTH_UDP_DRIVE_H

#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <math.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>

enum { frame_size = 40, crc_at = 36 };
static const double watchdog = 0.1; /* s without a force, after which there is none */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static uint32_t crc32_of(const unsigned char* bytes, int count) {
  uint32_t crc = 0xffffffffu;
  for (int i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/* Little-endian, whatever the machine is. */
static uint64_t get(const unsigned char* bytes, int count) {
  uint64_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = (value << 8) | bytes[i];
  return value;
}

static void put(unsigned char* bytes, uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes[i] = (unsigned char)(value >> (8 * i));
}

static double get_double(const unsigned char* bytes) {
  const uint64_t bits = get(bytes, 8);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static void put_double(unsigned char* bytes, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  put(bytes, bits, 8);
}

/* Serves one host after the other, for ever. `port` 0: any free one. `read_position`: m or rad. `apply_force`: N or N m, from
 * then on. 1 where there is no socket. */
static int udp_drive(int port, double (*read_position)(void), void (*apply_force)(double)) {
  const int s = socket(AF_INET, SOCK_DGRAM, 0);
  struct sockaddr_in own = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK); /* INADDR_ANY for a rig on another machine */
  socklen_t own_size = sizeof own;
  if (s < 0 || bind(s, (struct sockaddr*)&own, sizeof own) != 0 ||
      getsockname(s, (struct sockaddr*)&own, &own_size) != 0) {
    perror("udp_drive");
    return 1;
  }
  const struct timeval wake = {0, 5000}; /* the watchdog must bark although nothing comes */
  setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &wake, sizeof wake);
  printf("port %d\n", (int)ntohs(own.sin_port));
  fflush(stdout);
  double last_force_at = -1.0, force = 0.0;
  int has_let_go = 1;
  struct sockaddr_in owner = own; /* whose forces are taken, until the watchdog lets go */
  for (;;) {
    unsigned char frame[frame_size + 1];
    struct sockaddr_in peer;
    socklen_t peer_size = sizeof peer;
    const ssize_t size = recvfrom(s, frame, sizeof frame, 0, (struct sockaddr*)&peer, &peer_size);
    if (!has_let_go && now() - last_force_at > watchdog) {
      apply_force(0.0);
      has_let_go = 1;
      printf("let go\n");
      fflush(stdout);
    }
    if (size != frame_size || get(frame + crc_at, 4) != crc32_of(frame, crc_at)) continue;
    const int is_owner = peer.sin_addr.s_addr == owner.sin_addr.s_addr && peer.sin_port == owner.sin_port;
    if (!has_let_go && !is_owner) continue; /* another rig holds the device */
    const double wanted = get_double(frame + 28);
    if (isfinite(wanted)) {
      if (has_let_go) printf("takes hold\n");
      fflush(stdout);
      owner = peer;
      has_let_go = 0;
      last_force_at = now();
      force = wanted;
      apply_force(force);
    }
    put_double(frame + 4, now());
    put_double(frame + 12, read_position());
    put_double(frame + 20, 0.0); /* velocity: not known */
    put_double(frame + 28, has_let_go ? NAN : force);
    put(frame + crc_at, crc32_of(frame, crc_at), 4);
    sendto(s, frame, frame_size, 0, (struct sockaddr*)&peer, peer_size);
  }
}

#endif
