"""The status values as metrics, in the text formats of Prometheus."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector

from yehu_server.live.osc.part_status import PART_STATUS, Kind
from yehu_server.live.osc.status import STATUS
from yehu_server.live.web.query import Told

NAMESPACE = "yehu"
FAMILIES = {Kind.GAUGE: GaugeMetricFamily, Kind.COUNTER: CounterMetricFamily}


class Metrics(Collector):
    """The status values that are numbers, read whenever metrics are requested.

    Parameters
    ----------
    told : callable
        Returns the status values, by name.
    parts : callable
        Returns those of each part, where there are several; they have the label ``part``.
    """

    def __init__(
        self, told: Callable[[], Told], parts: Callable[[], Sequence[Told]] = tuple
    ) -> None:
        self._told = told
        self._parts = parts
        self._registry = CollectorRegistry()
        self._registry.register(self)

    def describe(self) -> list[Metric]:
        """See `Collector`; the names come from the table, none are registered."""
        return []

    def collect(self) -> Iterator[Metric]:
        """See `Collector`."""
        status = self._told().status
        for row in STATUS:
            family = FAMILIES.get(row.kind)
            if family is not None:
                yield family(f"{NAMESPACE}_{row.name}", row.doc, value=float(status[row.name]))
        parts = self._parts()
        for own in PART_STATUS if parts else ():
            metric = FAMILIES[own.kind](f"{NAMESPACE}_part_{own.name}", own.doc, labels=["part"])
            for number, part in enumerate(parts, start=1):
                metric.add_metric([str(number)], float(part.status[own.name]))
            yield metric

    def text(self, accept: str) -> tuple[bytes, str]:
        """The metrics, in a format that a client's Accept header asks for, and its content type."""
        try:
            encode, content_type = choose_encoder(accept)
        except (TypeError, ValueError):  # prometheus-client fails on malformed versions
            encode, content_type = choose_encoder("")
        return encode(self._registry), content_type
