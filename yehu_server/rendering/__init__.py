"""Scores to sound files, faster than real time: one instrument, or an ensemble and its stems."""

from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.rendering.summary import PartSummary, Summary
from yehu_server.rendering.to_files import render

__all__ = ["Options", "Part", "PartSummary", "Performance", "Summary", "render"]
