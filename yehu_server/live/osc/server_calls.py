"""The OSC calls that no part has of its own: any value, recordings, subscriptions, ping."""

from functools import cache

from yehu_server.live.osc.call import ADDRESS, NAME, Request, osc_call
from yehu_server.live.osc.change_publisher import own_address, topic_of
from yehu_server.live.osc.context import GroupCalls
from yehu_server.live.osc.osc_addresses import fitting, is_pattern, parameter_of, readable
from yehu_server.live.osc.packets import answer, pack
from yehu_server.live.osc.playing_calls import port_of
from yehu_server.live.part_addresses import check_own, check_part, split_group
from yehu_server.params.table import PREFIX, UNIT, read


class ServerCalls(GroupCalls):
    """Carries out the calls that are for all parts."""

    @osc_call(
        "/get", "Sends the value of a parameter, or a status value.", ADDRESS, is_for_all=True
    )
    def _get(self, call: Request) -> None:
        wanted = call.word().removeprefix(PREFIX)
        known = readable(len(self._context.players))
        if is_pattern(wanted):
            addresses = fitting(wanted, known)
        elif wanted in known:
            addresses = [wanted]
        else:
            addresses = [self._found(wanted)]
        call.check_peer()
        read_topic = cache(self._clients.read)
        for address in addresses:
            values = read_topic(topic_of(address))
            self._send(call.peer, address, read(values, own_address(address)))

    def _found(self, address: str) -> str:
        """The address of a parameter; raises ParameterError, with a similar one if there is one."""
        group, own = split_group(address)
        check_part(group, len(self._context.players))
        check_own(group, own)
        form = UNIT if own.endswith(UNIT) else ""
        return group + parameter_of(own.removesuffix(UNIT)) + form

    @osc_call("/unsubscribe", "Ends all subscriptions.", is_for_all=True)
    def _unsubscribe(self, call: Request) -> None:
        numbers = call.numbers(0, 1)
        peer = call.peer.at(port_of(numbers[0])) if numbers else call.peer
        self._clients.unsubscribe(peer)
        peer.send(pack(f"{self._prefix}/unsubscribed"))

    @osc_call("/record/start", "Records into the recordings folder.", NAME, is_for_all=True)
    def _record_start(self, call: Request) -> None:
        self._send(call.peer, "/record/started", self._context.start_recording(call.word()))

    @osc_call("/record/stop", "Ends the recording.", is_for_all=True)
    def _record_stop(self, call: Request) -> None:
        self._send(call.peer, "/record/stopped", self._context.stop_recording())

    @osc_call("/ping", "Answers with the same arguments.", is_for_all=True)
    def _ping(self, call: Request) -> None:
        self._clients.send(call.peer, answer(f"{self._prefix}/pong", call.payload))
