"""Threads, exceptions in a progress function, and Ctrl-C."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

import shapeop
from near import flat
from samples import sheet


def test_a_solver_that_another_thread_uses_is_busy() -> None:
    started, go_on = threading.Event(), threading.Event()

    def progress(_: shapeop.Progress) -> None:
        started.set()
        assert go_on.wait(30)

    solver = sheet(4)
    before = flat(solver.points)
    reports: list[shapeop.Report] = []
    thread = threading.Thread(target=lambda: reports.append(solver.solve_until(2, tolerance=0, progress=progress)))
    thread.start()
    try:
        assert started.wait(30)
        calls: list[Any] = [
            lambda: solver.points,
            lambda: setattr(solver, "points", [[0, 0, 0]] * 16),
            lambda: solver.solve(1),
            lambda: solver.solve_until(),
            lambda: solver.add("Plane", [0, 1, 2]),
            lambda: solver.energy,
            lambda: solver.constraint_count,
            lambda: solver.init(),
            lambda: solver.set_damping(0.5),
            lambda: solver.add_gravity([0, 0, 1]),
            lambda: solver.close(),
        ]
        for call in calls:
            with pytest.raises(shapeop.BusyError, match="another call is using it") as caught:
                call()
            assert caught.value.code is shapeop.ErrorCode.BUSY
    finally:
        go_on.set()
        thread.join()
    assert reports[0].iterations == 2
    assert flat(solver.points) != before
    solver.close()


def test_many_threads_solve_different_solvers_to_the_same_bits() -> None:
    results: list[list[float]] = []

    def work() -> None:
        with sheet(12) as solver:
            solver.solve_until(20, tolerance=0)
            results.append(flat(solver.points))

    threads = [threading.Thread(target=work) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 6
    assert all(result == results[0] for result in results)


@pytest.mark.parametrize("kind", [KeyError, SystemExit, GeneratorExit, KeyboardInterrupt])
def test_an_exception_in_the_progress_function_ends_the_solve_and_is_raised_after(kind: type[BaseException]) -> None:
    calls: list[int] = []

    def progress(told: shapeop.Progress) -> None:
        calls.append(told.iteration)
        if told.iteration == 3:
            raise kind("on purpose")

    with sheet(4) as solver:
        with pytest.raises(kind, match="on purpose"):
            solver.solve_until(tolerance=0, progress=progress)
        assert calls == [1, 2, 3]
        assert solver.solve_until(1, tolerance=0).iterations == 1


def test_an_exception_in_another_thread_s_progress_function_reaches_that_thread() -> None:
    caught: list[BaseException] = []

    def work() -> None:
        try:
            with sheet(4) as solver:
                solver.solve_until(progress=lambda _: 1 / 0)
        except ZeroDivisionError as error:
            caught.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert len(caught) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="signals cannot be sent to oneself alone on Windows")
@pytest.mark.parametrize("progress", ["None", "lambda _: None", "lambda _: time.sleep(0.01)"])
def test_ctrl_c_ends_a_solve_without_a_word(progress: str) -> None:
    # Its own process, as the signal must not reach the tests; the thread waits for the solve to be under way.
    program = f"""
import os, signal, sys, threading, time
# Whoever started the tests may have had it ignored, as shells do for what runs in the background.
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {str(Path(__file__).parent)!r})
from samples import sheet
solver = sheet(60)
solver.set_acceleration("none")
count = 0
def interrupt():
    time.sleep(0.3)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
begin = time.monotonic()
try:
    solver.solve_until(10**9, tolerance=0, time_budget_seconds=60, progress={progress})
except KeyboardInterrupt:
    print("interrupted", time.monotonic() - begin < 30, signal.getsignal(signal.SIGINT) is signal.default_int_handler)
    print(solver.solve_until(1, tolerance=0).iterations)
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=120)
    assert (run.stdout.split(), run.stderr) == (["interrupted", "True", "True", "1"], "")


@pytest.mark.skipif(sys.platform == "win32", reason="signals cannot be sent to oneself alone on Windows")
def test_the_program_s_own_handler_gets_ctrl_c_and_is_kept() -> None:
    got: list[int] = []

    def handler(number: int, _: object) -> None:
        got.append(number)

    before = signal.signal(signal.SIGINT, handler)
    try:
        with sheet(4) as solver:
            report = solver.solve_until(
                5,
                tolerance=0,
                progress=lambda told: signal.raise_signal(signal.SIGINT) if told.iteration == 2 else None,
            )
            assert report.iterations == 5
            assert got == [signal.SIGINT]
            assert signal.getsignal(signal.SIGINT) is handler
    finally:
        signal.signal(signal.SIGINT, before)
