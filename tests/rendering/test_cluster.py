"""Jobs on a cluster: a real scheduler, and workers that are processes of their own."""

import pickle
import shutil
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
import some_jobs
from clusters import Processes, cluster_in, needs_distributed
from waiting import LONG_S, until

import yehu_server
from yehu_server.errors import YehuError
from yehu_server.rendering import cluster as clusters
from yehu_server.rendering import cluster_worker
from yehu_server.rendering.cluster import Cluster, scheduler_address
from yehu_server.rendering.plain_unpickling import ForeignError
from yehu_server.util.processes import machine_lock

pytestmark = needs_distributed


@pytest.fixture(autouse=True)
def _as_it_is_now() -> None:
    """Code may be edited while tests run: a test has what is there when it starts."""
    cluster_worker.identity.cache_clear()


@pytest.fixture(scope="module")
def processes(tmp_path_factory, everything) -> Processes:
    with cluster_in(tmp_path_factory.mktemp("cluster"), 2 if everything else 1) as found:
        yield found


@pytest.fixture
def own(tmp_path) -> Processes:
    """A cluster of one test, which may break it; with no worker yet."""
    with cluster_in(tmp_path, 0) as found:
        yield found


def ends(cluster: Cluster, perform, tasks) -> dict:
    return {event.job: event for event in cluster.perform_all(perform, tasks)}


# ---------------------------------------------------------------- jobs


def test_each_task_is_done_once_and_by_others(processes):
    with Cluster(str(processes.file)) as cluster:
        found = ends(cluster, some_jobs.double, range(60))
        assert [found[job].result for job in range(60)] == list(range(0, 120, 2))
        where = ends(cluster, some_jobs.fall, [0] * 20)
    pids = {worker.pid for worker in processes.workers}
    assert {event.result for event in where.values()} <= pids


def workers_of(processes: Processes) -> int:
    return processes.log.read_text().count("Registered to")


@pytest.mark.slow
def test_a_job_that_kills_every_worker_is_given_up(tmp_path):
    few = {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
    with cluster_in(tmp_path, 2, **few) as processes:
        until(lambda: workers_of(processes) == 2, within_s=LONG_S)
        with Cluster(str(processes.file)) as cluster:
            [event] = cluster.perform_all(some_jobs.fall, [-1])
    assert event.died == "killed on 1 workers"


def test_a_job_that_raises_is_reported(processes):
    with Cluster(str(processes.file)) as cluster:
        [event] = cluster.perform_all(some_jobs.double, [None])
    assert event.died.startswith("ended by TypeError")


@pytest.mark.slow
def test_what_is_set_up_is_set_up_once_in_each_process_and_by_one_at_a_time(own, tmp_path):
    own.add_worker()
    own.add_worker()
    until(lambda: workers_of(own) == 2, within_s=LONG_S)
    with Cluster(str(own.file), some_jobs.SetUp(tmp_path)) as cluster:
        where = ends(cluster, some_jobs.slow, [0.05] * 40)
    pids = {event.result for event in where.values()}
    assert pids == {worker.pid for worker in own.workers}
    times = sorted(
        tuple(map(float, file.read_text().split())) for file in tmp_path.glob("set-up-*")
    )
    assert len(times) == len(pids)
    assert times[0][1] <= times[1][0]


# ---------------------------------------------------------------- what strangers answer


@pytest.mark.slow
def test_what_a_stranger_has_workers_and_scheduler_send_runs_nothing_here(own, tmp_path):
    touched = tmp_path / "touched"
    own.add_worker()
    until(lambda: workers_of(own) == 1, within_s=LONG_S)
    with Cluster(str(own.file)) as cluster:
        connected = cluster._client
        # What workers print and warn of reaches all clients, as a pickle.
        for topic in ("warn", "print"):
            told = {"message": pickle.dumps(some_jobs.Touching(touched)), "args": ("STRANGE",)}
            connected.log_event(topic, told)
        [found] = connected.run(some_jobs.Touching, touched).values()
        assert type(found).__name__ != "Touching"
        connected.run(some_jobs.poison, touched)
        [event] = cluster.perform_all(some_jobs.double, [1])
    assert event.died == "ended by an answer that is none", event
    assert not touched.exists()


# ---------------------------------------------------------------- what is no cluster


@pytest.fixture
def copy(tmp_path) -> Path:
    """A folder with another version of the package: what a worker needs of it, and a change."""
    package = Path(yehu_server.__file__).parent
    other = tmp_path / "other" / "yehu_server"
    for folder in ("util", "system"):
        shutil.copytree(package / folder, other / folder)
    modules = ("compile/__init__", "compile/levels", "rendering/__init__", "rendering/workers")
    for name in ("__init__", "errors", *modules):
        (other / name).parent.mkdir(exist_ok=True)
        shutil.copy(package / f"{name}.py", other / f"{name}.py")
    worker = (package / "rendering" / "cluster_worker.py").read_text("utf-8")
    (other / "rendering" / "cluster_worker.py").write_text(worker + "CHANGED = True\n", "utf-8")
    return other.parent


@pytest.mark.slow
def test_a_worker_of_another_version_is_refused_in_one_line(own, copy):
    own.add_worker(PYTHONPATH=str(copy))
    until(lambda: workers_of(own) == 1, within_s=LONG_S)
    with pytest.raises(YehuError, match=r"tcp://.* has yehu-server .*: install the same") as error:
        Cluster(str(own.file)).__enter__()
    assert "\n" not in str(error.value)


@pytest.mark.slow
def test_workers_without_the_package_are_reported(own, tmp_path):
    (tmp_path / "yehu_server").mkdir()
    (tmp_path / "yehu_server" / "__init__.py").touch()
    own.add_worker(PYTHONPATH=str(tmp_path))
    until(lambda: workers_of(own) == 1, within_s=LONG_S)
    with pytest.raises(YehuError, match="yehu-server is not installed there"):
        Cluster(str(own.file)).__enter__()


@pytest.mark.slow
def test_a_scheduler_without_workers_is_reported(own, monkeypatch):
    monkeypatch.setattr(clusters, "CONNECT_S", 1.0)
    with pytest.raises(YehuError, match="the scheduler has no workers"):
        Cluster(str(own.file)).__enter__()


@pytest.mark.slow
def test_a_scheduler_that_is_lost_is_reported(own, monkeypatch):
    monkeypatch.setattr(clusters, "CONNECT_S", 1.0)
    own.add_worker()
    until(lambda: workers_of(own) == 1, within_s=LONG_S)
    with Cluster(str(own.file)) as cluster:
        events = cluster.perform_all(some_jobs.slow, [0.05] * 1000)
        next(events)
        own.scheduler.kill()
        with pytest.raises(YehuError, match="the scheduler is lost"):
            list(events)


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(YehuError, match=r"-m pip install 'yehu-server\[cluster\]'"):
        Cluster("127.0.0.1")


def test_an_error_that_is_like_none_of_dask_is_reported():
    for arguments in (("a", "b", "c"), ("a", "b", None), ()):
        error = type("KilledWorker", (ForeignError,), {})(*arguments)
        failed = SimpleNamespace(status="error", exception=lambda error=error: error)
        event = Cluster._event(None, failed, 0, None)
        assert event.died.startswith("ended by KilledWorker")


def test_an_address_is_completed_or_refused():
    for text, address in (
        ("host", "tcp://host:8786"),
        ("10.0.0.1:99", "tcp://10.0.0.1:99"),
        ("tls://a.b.c:8786", "tls://a.b.c:8786"),
        ("tcp://[::1]:5", "tcp://[::1]:5"),
    ):
        assert scheduler_address(text) == address
    for text in (
        "",
        "a b",
        "http://x",
        "host:0",
        "host:70000",
        f"h:{'9' * 5000}",
        "a:b:c",
        "tcp://",
    ):
        with pytest.raises(YehuError, match="is not the address of a scheduler"):
            scheduler_address(text)


def test_a_file_that_is_no_schedulers_is_refused(tmp_path):
    for text in ("", "{}", "[]", '{"address": 5}', '{"address": "a b"}'):
        (tmp_path / "a.json").write_text(text)
        with pytest.raises(YehuError, match=r"a\.json: |scheduler"):
            scheduler_address(str(tmp_path / "a.json"))
    with pytest.raises(YehuError, match="no such file"):
        scheduler_address(str(tmp_path / "none.json"))


@pytest.mark.slow
def test_a_lock_keeps_processes_apart(tmp_path):
    program = (
        "import sys; from pathlib import Path\n"
        "from yehu_server.util.processes import machine_lock\n"
        "Path(sys.argv[1], 'wants').touch()\n"
        "with machine_lock(Path(sys.argv[1]), 'a'): Path(sys.argv[1], 'has').touch()"
    )
    with machine_lock(tmp_path, "a"):
        other = subprocess.Popen([sys.executable, "-c", program, str(tmp_path)])
        until((tmp_path / "wants").exists, within_s=LONG_S)
        time.sleep(0.2)
        assert not (tmp_path / "has").exists()
    assert other.wait(timeout=60) == 0
    assert (tmp_path / "has").exists()
