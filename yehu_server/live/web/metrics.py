"""The status values as metrics, in the text formats of Prometheus."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector

from yehu_server.live.osc.status import PART_STATUS, STATUS, Kind
from yehu_server.live.part_addresses import FIRST, group_of

Status = Mapping[str, float | str]  # by name
NAMESPACE = "yehu"
FAMILIES = {Kind.GAUGE: GaugeMetricFamily, Kind.COUNTER: CounterMetricFamily}


class Metrics(Collector):
    """The status values that are numbers, read whenever metrics are requested.

    `status`: returns the status values of a group of addresses.
    `parts`: number of parts; where there are several, each has metrics with the label ``part``.
    """

    def __init__(self, status: Callable[[str], Status], parts: int) -> None:
        self._status = status
        self._parts = parts
        self._registry = CollectorRegistry()
        self._registry.register(self)

    def describe(self) -> list[Metric]:
        """See `Collector`; the names come from the table, none are registered."""
        return []

    def collect(self) -> Iterator[Metric]:
        """See `Collector`."""
        status = self._status(FIRST)
        for row in STATUS:
            family = FAMILIES.get(row.kind)
            if family is not None:
                yield family(f"{NAMESPACE}_{row.name}", row.doc, value=float(status[row.name]))
        several = range(self._parts) if self._parts > 1 else ()
        parts = [self._status(group_of(part)) for part in several]
        for own in PART_STATUS if parts else ():
            metric = FAMILIES[own.kind](f"{NAMESPACE}_part_{own.name}", own.doc, labels=["part"])
            for number, part in enumerate(parts, start=1):
                metric.add_metric([str(number)], float(part[own.name]))
            yield metric

    def text(self, accept: str) -> tuple[bytes, str]:
        """The metrics, in a format that a client's Accept header asks for, and its content type."""
        try:
            encode, content_type = choose_encoder(accept)
        except (TypeError, ValueError):  # prometheus-client fails on malformed versions
            encode, content_type = choose_encoder("")
        return encode(self._registry), content_type
