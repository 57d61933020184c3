"""OSCQuery and metrics by HTTP, asked by a client independent of the package."""

import socket

import pytest
from waiting import until
from web_client import ask, walk

from yehu_server.live.network import Allowed
from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.osc.status import STATUS, Kind
from yehu_server.live.web import server
from yehu_server.live.web.server import PARAMETERS, WebOptions
from yehu_server.params.table import TABLE
from yehu_server.util.files import shipped_folder

HOST = "127.0.0.1"


@pytest.fixture(scope="module")
def port(shared_web) -> int:
    return shared_web.server.web.port


@pytest.fixture
def nodes(port):
    return dict(walk(ask(port, "/").json))


# ---------------------------------------------------------------- the tree


def test_the_whole_tree_is_there_and_each_node_by_itself(port, nodes):
    assert {"/yehu" + call.address for call in CALLS} <= set(nodes)
    assert {"/yehu/status/" + row.name for row in STATUS} <= set(nodes)
    assert {"/yehu" + param.address for param in TABLE} <= set(nodes)
    for path in [
        "/yehu/bow",  # a container
        "/yehu/bow/force",  # "f"
        "/yehu/bow/force/unit",
        "/yehu/note",  # "ff", to be called
        "/yehu/record/start",  # "s"
        "/yehu/panic",  # "N"
        "/yehu/status/device",  # "s", to be read
        "/yehu/status/device_losses",  # "i"
    ]:
        assert ask(port, path).json == nodes[path]


def test_a_value_set_over_osc_is_read(shared_web, port):
    client = shared_web.client()
    client.send("/bow/force", 1.875)
    assert client.wait_for("/bow/force") == [1.875]
    assert ask(port, "/yehu/bow/force?VALUE").json == {"VALUE": [1.875]}
    client.send("/bow/force/unit", 0.625)
    client.wait_for("/bow/force/unit")
    assert ask(port, "/yehu/bow/force/unit?VALUE").json == {"VALUE": [0.625]}
    assert ask(port, "/yehu/bow/force?VALUE").json == {"VALUE": [3.125]}
    client.send("/bow/force", 0.5)
    client.sync()


# ---------------------------------------------------------------- queries


def test_one_attribute_is_all_that_is_answered(port):
    assert ask(port, "/yehu/bow/force?TYPE").json == {"TYPE": "f"}
    assert ask(port, "/yehu/bow?FULL_PATH").json == {"FULL_PATH": "/yehu/bow"}
    assert list(ask(port, "/yehu/bow?CONTENTS").json) == ["CONTENTS"]
    both = ask(port, "/yehu/bow/force?TYPE&ACCESS").json
    assert both == {"TYPE": "f", "ACCESS": 3}


def test_the_proposals_status_codes(port):
    for path, status in [
        ("/", 200),
        ("/yehu/", 200),
        ("/yehu/bow/force?VALUE", 200),
        ("/yehu/note?TYPE", 200),
        ("/yehu/note?VALUE", 204),  # may only be set
        ("/yehu/bow?VALUE", 204),  # a container
        ("/yehu/panic?RANGE", 204),
        ("/yehu/status/load?CONTENTS", 204),
        ("/yehu/bow/force?COLOUR", 400),
        ("/yehu/bow/force?value", 400),
        ("/yehu/bow/force?TAGS", 400),  # of the proposal, but not in EXTENSIONS
        ("/yehu/nothing", 404),
        ("/yehu/nothing?VALUE", 404),
        ("/bow/force", 404),
        ("/yehu/%00", 404),
        ("/yehu/..%2f..%2fetc/passwd", 404),
        ("/README.md", 404),
    ]:
        assert ask(port, path).status == status, path
    for method in ("POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"):
        assert ask(port, "/yehu/bow/force", method).status == 405, method
    answer = ask(port, "/yehu/bow/force", "HEAD")
    assert (answer.status, answer.body) == (200, b"")


# ---------------------------------------------------------------- pages


def test_the_page_of_parameters_is_served_where_there_is_one(port, monkeypatch, tmp_path):
    is_there = (shipped_folder("mappings") / PARAMETERS).exists()
    assert ask(port, f"/{PARAMETERS}").status == (200 if is_there else 404)
    (tmp_path / PARAMETERS).write_text("<p>蘇</p>", "utf-8")
    (tmp_path / "secret.html").write_text("no", "utf-8")
    monkeypatch.setattr(server, "shipped_folder", lambda _name: tmp_path)
    answer = ask(port, f"/{PARAMETERS}")
    assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    assert answer.body.decode() == "<p>蘇</p>"
    assert ask(port, "/secret.html").status == 404


# ---------------------------------------------------------------- metrics


def test_every_number_of_the_status_is_a_metric(port):
    until(lambda: int(ask(port, "/yehu/status/frame").json["VALUE"][0]), "a block that is played")
    answer = ask(port, "/metrics")
    assert answer.headers["Content-Type"].startswith("text/plain; version=0.0.4")
    lines = answer.body.decode().splitlines()
    types = dict(line.split()[2:] for line in lines if line.startswith("# TYPE"))
    values = dict(line.split() for line in lines if not line.startswith("#"))
    names = {
        f"yehu_{row.name}" + ("_total" if row.kind is Kind.COUNTER else ""): row.kind.value
        for row in STATUS
        if row.kind is not Kind.TEXT
    }
    assert types == names
    assert set(values) == set(names)
    assert float(values["yehu_rate"]) == 48000.0
    assert float(values["yehu_frame_total"]) > 0.0


# ---------------------------------------------------------------- who is not answered


def test_a_page_from_elsewhere_is_refused_and_counted(shared_web, port):
    before = shared_web.server.status()["http_refused"]
    for headers in ({"Origin": f"http://{HOST}:1"}, {"Host": "evil.example"}):
        answer = ask(port, "/yehu/bow/force", **headers)
        assert answer.status == 403
        assert b"VALUE" not in answer.body
    assert shared_web.server.status()["http_refused"] == before + 2
    assert ask(port, "/yehu", Origin=f"http://{HOST}:{port}").status == 200


def test_who_is_not_on_the_list_is_refused(make_live):
    live = make_live(http=WebOptions((HOST, 0), Allowed(["192.0.2.0/24"])))
    assert ask(live.server.web.port, "/").status == 403
    assert ask(live.server.web.port, "/metrics").status == 403


def raw(port: int, data: bytes) -> bytes:
    """The answer to bytes, until the server closes the connection."""
    with socket.create_connection((HOST, port), timeout=20.0) as connection:
        connection.sendall(data)
        answer = b""
        try:
            while more := connection.recv(1 << 16):
                answer += more
        except ConnectionResetError:
            pass
        return answer


def test_nonsense_is_refused_is_no_defect_and_the_server_goes_on(shared_web, port, subtests):
    head = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"
    for data, status in [
        (b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n", b"4"),
        (head + b"X: " + b"a" * 100_000 + b"\r\n\r\n", b"4"),
        (head + b"X: a\r\n" * 1000 + b"\r\n", b"4"),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc" + bytes(range(256)), b"4"),  # TLS
        (b"/yehu/note\0\0,ff\0" + bytes(8), b"4"),
        (head + b"Content-Length: -1\r\n\r\n", b"4"),
        (head + b"Content-Length: 65537\r\n\r\n" + bytes(65537), b"413"),
        *(
            (head + b"Upgrade: websocket\r\n" + line + b"\r\n\r\n", b"400")
            for line in (b"Connection: \x98", b"Upgrade: \xff", b"Accept: \xed\xa0\x80", b"X: \xc0")
        ),
    ]:
        with subtests.test(data=data[:80]):
            answer = raw(port, data)
            assert answer.startswith((b"HTTP/1.1 " + status, b"HTTP/1.0 " + status))
    assert ask(port, "/yehu/bow/force?TYPE").status == 200
    assert shared_web.server.status()["http_failures"] == 0


# ---------------------------------------------------------------- begin and end


def test_a_defect_is_counted_and_ends_one_request_only(shared_web, port, monkeypatch):
    before = shared_web.server.status()["http_failures"]
    with monkeypatch.context() as patch:
        patch.setattr("yehu_server.live.web.server.query.node_at", lambda *_: 1 / 0)
        patch.setattr("yehu_server.live.web.server.log.exception", lambda *_: None)
        assert ask(port, "/yehu").status == 500
    assert ask(port, "/yehu").status == 200
    shared_web.server.web.traffic.failures = before
