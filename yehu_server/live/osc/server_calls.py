"""The OSC calls that no part has of its own: any value, recordings, subscriptions, ping."""

from functools import cache

from yehu_server.errors import RefusedError
from yehu_server.live.osc.call import ADDRESS, NAME, Request, osc_call
from yehu_server.live.osc.change_publisher import own_address, topic_of
from yehu_server.live.osc.context import GroupCalls
from yehu_server.live.osc.osc_addresses import fitting, is_pattern, readable, unknown
from yehu_server.live.osc.packets import answer
from yehu_server.live.traffic_limits import PATTERN
from yehu_server.params.table import PREFIX, read


class ServerCalls(GroupCalls):
    """Carries out the calls that are for all parts."""

    @osc_call(
        "/get", "Sends the value of a parameter, or a status value.", ADDRESS, is_for_all=True
    )
    def _get(self, call: Request) -> None:
        wanted, parts = call.word().removeprefix(PREFIX), len(self._context.players)
        known = readable(parts)
        if is_pattern(wanted):
            addresses = fitting(wanted, known)
        elif wanted in known:
            addresses = [wanted]
        elif PREFIX + wanted in self._context.addresses:
            raise RefusedError(f"{PREFIX}{wanted} has no value")
        else:
            asked, readable_ones = f"{PREFIX}/{wanted.lstrip('/')}", [PREFIX + one for one in known]
            raise RefusedError(f"{asked[:PATTERN]}: {unknown(asked, parts, readable_ones)}")
        call.check_peer()
        read_topic = cache(self._clients.read)
        for address in addresses:
            values = read_topic(topic_of(address))
            self._send(call.peer, address, read(values, own_address(address)))

    @osc_call("/unsubscribe", "Ends all subscriptions.", is_for_all=True)
    def _unsubscribe(self, call: Request) -> None:
        self._end_subscriptions(call.peer, call.numbers(0, 1))

    @osc_call("/record/start", "Records into the recordings folder.", NAME, is_for_all=True)
    def _record_start(self, call: Request) -> None:
        self._send(call.peer, "/record/started", self._context.start_recording(call.word()))

    @osc_call("/record/stop", "Ends the recording.", is_for_all=True)
    def _record_stop(self, call: Request) -> None:
        self._send(call.peer, "/record/stopped", self._context.stop_recording())

    @osc_call("/ping", "Answers with the same arguments.", is_for_all=True)
    def _ping(self, call: Request) -> None:
        self._clients.send(call.peer, answer(f"{self._prefix}/pong", call.payload))
