"""All limits of traffic: what senders, guests and clients may send, hold and be sent.

Sizes are in bytes. ``A_HOST`` is of all ports of one host together.
"""

from yehu_server.core.engine.mailbox import PAGE_QUEUES

# OSC that is received. A longer datagram is dropped; a longer packet ends its connection.
SOCKET_BUFFER = 32 << 20  # asked for; the system may grant less
DATAGRAM = 1 << 14
PACKET = (1 << 16) - 1  # in a stream: less than a STUN message's beginning says as a length
ARGUMENTS = 256  # of a message, which is read in one step
NESTING = 32  # bundles within bundles, arrays within arrays
PATTERN = 256  # characters
# What waits, of all senders: to be handled, and for its time (some 65,000 notes). A sender may hold
# as much as it leaves free.
WAITING, SCHEDULED = 16 << 20, 20 << 20
OVERHEAD = 256  # memory of a packet that waits, beside its own bytes
STREAM_READ = 1 << 16  # of a connection at a time; it is not read again before that is handled
WEB_SOCKET_WAITING = 1 << 16  # after which its sender has to wait
CALLS_WAITING = 64  # of all WebSockets, likewise
# Connections for OSC. One too many replaces one that has sent nothing for QUIET_S, or never sent a
# packet within FIRST_PACKET_S, unless it is sent changes of values.
CONNECTIONS, CONNECTIONS_A_HOST = 64, 32
QUIET_S, FIRST_PACKET_S = 60.0, 10.0

# What is sent. The address of a datagram may be forged, so other hosts get no more than this.
ANSWERED = 1 << 17  # to a port of this machine, at once and a second
ANSWERED_TO_A_HOST, ANSWERED_TO_ALL_HOSTS = 2, 16  # times as much
UNSENT = 1 << 18  # waiting for one connection or WebSocket
ERRORS_A_SECOND, ERRORS_AT_ONCE = 10.0, 20.0  # to one client
LOGGED_ERRORS_A_SECOND, LOGGED_ERRORS_AT_ONCE = 0.1, 5.0  # in the terminal, of all
ERRORS_COUNTED_AFTER_S = 2.0  # without another one
WRONG_ADDRESSES = 1024  # of which an error was logged
CHANGES_AT_ONCE = 512  # messages of one round to all subscribers
SUBSCRIBERS, SUBSCRIBERS_A_HOST = 64, 32
PEERS = 1024  # UDP peers, hosts and clients that are remembered
CLIENTS_ECHOED = 8192  # where there are more, new ones are not echoed

# Files, of all clients together.
SAVES_A_SECOND, SAVES_AT_ONCE = 1.0, 10.0  # presets, learned controls
RECORDINGS_A_SECOND, RECORDINGS_AT_ONCE, RECORDINGS = 1.0, 10.0, 1000  # and in the folder

# HTTP, WebSockets and pages. One connection too many closes the oldest of the host with most.
WEB_CONNECTIONS, WEB_CONNECTIONS_A_HOST = 256, 128  # with those that have sent no request
WEB_SOCKETS, WEB_SOCKETS_A_HOST = PAGE_QUEUES, 32
WEB_IDLE_S = 15.0  # before an idle connection is closed
WEB_BODY, WEB_FRAME = 1 << 16, 1 << 16
PAGE_UNSENT = 1 << 16  # waiting for one page
PAGE_EVENTS = 1024  # of a message
PAGE_EVENTS_A_SECOND, PAGE_EVENTS_AT_ONCE = 2000.0, 1024.0  # of one; of all pages together
PINS_AT_ONCE, PIN_AGAIN_S = 10, 10.0  # wrong ones of a host, and one more in this time
PINS_OF_ALL_AT_ONCE, PINS_OF_ALL_A_SECOND = 100, 0.2  # of all hosts: a million take two months
