/* Virtual MIDI ports for a browser, where the kernel has no sequencer: preloaded, it stands for ALSA's.
 *
 * YEHU_MIDI_PORTS names a FIFO. Records of 32 bytes come in: what ('+' a port comes, '-' it goes, 'm' a message),
 * the client, the length, and the name or the message. A message is encoded and decoded by ALSA's own library.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { READS = 1 << 0 | 1 << 5, GENERIC = 1 << 1 | 1 << 20, USER = 1, PORT_START = 63, PORT_EXIT = 64, ANNOUNCE = 1, FIRST = 16, CLIENTS = 64 };

/* As alsa/seq_event.h has it. */
struct event {
    unsigned char type, flags, tag, queue;
    unsigned int time[2];
    unsigned char source[2], dest[2], data[12];
};
struct record { char what; unsigned char client, length; char bytes[29]; };
struct info { int client, port; }; /* of a client or a port */

static int fifo = -1;
static char names[CLIENTS][30]; /* empty: there is no such client */
static void *coder;

int snd_midi_event_new(size_t size, void **made);
long snd_midi_event_encode(void *one, const unsigned char *bytes, long count, struct event *event);

int snd_seq_open(void **handle, const char *name, int streams, int mode) {
    static int opened;
    const char *path = getenv("YEHU_MIDI_PORTS");
    (void)name, (void)streams, (void)mode;
    if (!path) return -ENOENT;
    if (fifo < 0) fifo = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (!coder) snd_midi_event_new(256, &coder);
    *handle = (void *)(long)(++opened);
    return fifo < 0 ? -errno : 0;
}
int snd_seq_close(void *handle) { return (void)handle, 0; }
int snd_seq_client_id(void *handle) { return CLIENTS + (int)(long)handle; }
int snd_seq_set_client_name(void *handle, const char *name) { return (void)handle, (void)name, 0; }
int snd_seq_create_simple_port(void *handle, const char *name, unsigned capability, unsigned type) {
    return (void)handle, (void)name, (void)capability, (void)type, 0;
}
int snd_seq_delete_simple_port(void *handle, int port) { return (void)handle, (void)port, 0; }
int snd_seq_subscribe_port(void *handle, void *subscription) { return (void)handle, (void)subscription, 0; }

/* -- which clients and ports there are -------------------------------------------------------- */

size_t snd_seq_client_info_sizeof(void) { return sizeof(struct info); }
size_t snd_seq_port_info_sizeof(void) { return sizeof(struct info); }
void snd_seq_client_info_set_client(struct info *info, int client) { info->client = client; }
int snd_seq_client_info_get_client(const struct info *info) { return info->client; }
int snd_seq_client_info_get_type(const struct info *info) { return (void)info, USER; }
const char *snd_seq_client_info_get_name(const struct info *info) { return names[info->client]; }
void snd_seq_port_info_set_client(struct info *info, int client) { info->client = client; }
void snd_seq_port_info_set_port(struct info *info, int port) { info->port = port; }
const unsigned char *snd_seq_port_info_get_addr(const struct info *info) {
    static unsigned char address[2];
    address[0] = (unsigned char)info->client, address[1] = (unsigned char)info->port;
    return address;
}
const char *snd_seq_port_info_get_name(const struct info *info) { return names[info->client]; }
unsigned snd_seq_port_info_get_capability(const struct info *info) { return (void)info, READS; }
unsigned snd_seq_port_info_get_type(const struct info *info) { return (void)info, GENERIC; }
int snd_seq_get_any_client_info(void *handle, int client, struct info *info) {
    (void)handle, info->client = client;
    return client >= 0 && client < CLIENTS && *names[client] ? 0 : -ENOENT;
}
int snd_seq_get_any_port_info(void *handle, int client, int port, struct info *info) {
    info->port = port;
    return snd_seq_get_any_client_info(handle, client, info) || port ? -ENOENT : 0;
}
int snd_seq_query_next_client(void *handle, struct info *info) {
    (void)handle;
    while (++info->client < CLIENTS)
        if (info->client >= 0 && *names[info->client]) return 0;
    return -ENOENT;
}
int snd_seq_query_next_port(void *handle, struct info *info) {
    return snd_seq_get_any_port_info(handle, info->client, info->port + 1, info);
}

/* -- what comes in ---------------------------------------------------------------------------- */

int snd_seq_poll_descriptors(void *handle, struct pollfd *into, unsigned space, short events) {
    (void)handle;
    if (space > 0) into[0] = (struct pollfd){fifo, events, 0};
    return 1;
}
int snd_seq_event_input(void *handle, struct event **into) {
    static struct event event;
    struct record record;
    (void)handle;
    if (read(fifo, &record, sizeof record) != sizeof record) return -EAGAIN;
    memset(&event, 0, sizeof event);
    *into = &event;
    if (record.what == 'm') {
        snd_midi_event_encode(coder, (unsigned char *)record.bytes, record.length, &event);
        event.source[0] = record.client;
        return 1;
    }
    const int comes = record.what == '+';
    event.type = comes ? PORT_START : PORT_EXIT;
    event.source[1] = ANNOUNCE, event.data[0] = record.client;
    memset(names[record.client], 0, sizeof *names);
    if (comes) memcpy(names[record.client], record.bytes, record.length);
    return 1;
}
int snd_seq_event_input_pending(void *handle, int fetches) { return (void)handle, (void)fetches, 0; }
int snd_seq_event_output_direct(void *handle, struct event *event) { return (void)handle, (void)event, 0; }
