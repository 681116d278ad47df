"""Long work: progress, Ctrl-C, other threads, forks; and nothing that grows."""

import gc
import io
import multiprocessing
import os
import signal
import sys
import threading
import time

import pytest
from conftest import EXAMPLES

import orthopanel as op


@pytest.fixture(scope="module")
def slow():
    """A trace of some seconds."""
    return op.Test.load(EXAMPLES / "misplaced-hit")


def test_progress_is_told(slow):
    told = []
    op.trace(slow, progress=lambda *of: told.append(of))
    works = {work for work, *_ in told}
    assert "tracing what the model lacks" in works
    done = [(done, of) for _, done, of, step in told if step]
    assert done and all(0 <= done <= of for done, of in done)


def test_progress_is_one_line_that_is_taken_away(slow, monkeypatch):
    seen = io.StringIO()
    monkeypatch.setattr(sys, "stderr", seen)
    op.trace(slow, progress=True)
    text = seen.getvalue()
    assert "tracing what the model lacks" in text and "\n" not in text and text.endswith(" \r")


def test_what_progress_raises_ends_the_work(slow):
    def tell(*_):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        op.trace(slow, progress=tell)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_a_trace(slow):
    started = threading.Event()

    def interrupt():
        started.wait(60)
        os.kill(os.getpid(), signal.SIGINT)

    # A shell that starts tests in the background lets them ignore the signal.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            op.trace(slow, progress=lambda *_: started.set())
            time.sleep(5)
    finally:
        signal.signal(signal.SIGINT, handler)
    thread.join()
    # And the next one runs.
    assert op.trace(slow).verdict == "explained"


def test_other_threads_run(slow):
    turns = []

    def count(stop):
        while not stop.is_set():
            turns.append(1)
            time.sleep(0.01)

    stop = threading.Event()
    thread = threading.Thread(target=count, args=(stop,))
    thread.start()
    op.identify(slow)
    before = len(turns)
    stop.set()
    thread.join()
    assert before > 5


def lines():
    model = op.Model.load(EXAMPLES / "plate.json")
    return model.accelerance([100.0, 200.0], -0.3, 0.3).tolist(), len(model.modes(20))


def in_another(path, answer):
    answer.put((op.trace(op.Test.load(path)).verdict, lines()))


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="forks")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_works_too(slow):
    due = (op.trace(slow).verdict, lines())
    context = multiprocessing.get_context("fork")
    answer = context.Queue()
    process = context.Process(target=in_another, args=(EXAMPLES / "misplaced-hit", answer))
    process.start()
    found = answer.get(timeout=120)
    process.join(60)
    assert (found, process.exitcode) == (due, 0)


def memory():
    """Resident bytes of this process."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="Linux")
def test_nothing_grows():
    model = op.Model.load(EXAMPLES / "plate.json")
    piece = op.Piece(0.8, 0.1, 0.03, 6.88)
    force = [[0.0, 1.0, 0.0, 0.0]] * 2

    def once():
        test = op.Test(piece)
        test.add_hits(force, force, 10240.0, -0.3, 0.3)
        test.add_frequencies([300.0, 800.0])
        op.Model.from_json(model.to_json()).constants
        with pytest.raises(op.InputError):
            op.Test(piece, structure="membrane")

    for _ in range(500):
        once()
    gc.collect()
    objects, before = len(gc.get_objects()), memory()
    for _ in range(10_000):
        once()
    gc.collect()
    assert len(gc.get_objects()) - objects < 200
    # A kilobyte a call would be ten megabytes.
    assert memory() - before < 5e6
