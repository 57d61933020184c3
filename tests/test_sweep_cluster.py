"""``yehu-server sweep --dask``: strokes on a cluster of workers."""

from __future__ import annotations

import json

import pytest
from clusters import cluster_in, needs_distributed

from yehu_server.rendering import cluster_worker

pytestmark = [pytest.mark.slow, needs_distributed]

BOWED = {"duration": 0.1, "controls": {"bow_force": 0.5, "bow_velocity": 0.2}}
# Not in the order of the alphabet.
VARIED = ("--vary", "bow_velocity=0.1,0.2", "--vary", "bow_force=0.2:2:4")


def test_a_cluster_finds_to_the_byte_what_one_machine_does(command, tmp_path):
    cluster_worker.identity.cache_clear()  # code may be edited while tests run
    gesture = tmp_path / "gesture.json"
    gesture.write_text(json.dumps(BOWED))
    code, _, err = command("sweep", gesture, "-o", tmp_path / "here.npz", *VARIED)
    assert code == 0, err
    with cluster_in(tmp_path) as cluster:
        there_too = ("-o", tmp_path / "there.npz", *VARIED, "--dask", cluster.file)
        code, _, err = command("sweep", gesture, *there_too)
    assert code == 0, err
    assert (tmp_path / "there.npz").read_bytes() == (tmp_path / "here.npz").read_bytes()
