"""The result in memory: what it checks, derives and says in short."""

import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

from slosh_cli.results.result import Result, Status

CONTRACT = [
    "name",
    "status",
    "braking_distance_m",
    "braking_time_s",
    "initial_speed_m_s",
    "torque_N_m",
    "liquid_model",
    "max_surface_m",
    "surface_limit_m",
    "min_wheel_load_N",
    "max_wheel_load_N",
    "max_wheel_unloading",
    "locked_time_s",
    "brake_torque_max_N_m",
    "speed_at_first_lock_m_s",
    "slide_protection_cycles",
    "slide_protection_air",
    "energy_residual",
    "steps",
    "rejected_steps",
    "solve_seconds",
    "in_model_range",
    "checks",
    "warnings",
]


def test_summary_has_the_keys_of_the_contract(result: Result) -> None:
    assert list(result.summary()) == CONTRACT


def test_summary_values(result: Result) -> None:
    summary = result.summary()
    assert summary["initial_speed_m_s"] == pytest.approx(80 / 3.6)
    assert summary["torque_N_m"] == 5000.0
    assert summary["liquid_model"] == "modal"
    assert type(summary["status"]) is str
    assert len(summary["min_wheel_load_N"]) == 4


def test_a_run_that_did_not_stop_says_why_and_has_no_distance(unfinished: Result) -> None:
    summary = unfinished.summary()
    assert summary["status"] == "time-limit"
    assert summary["braking_distance_m"] is None
    assert summary["warnings"][-1] == unfinished.reason


def test_largest_unloading_is_that_of_the_wheel_that_loses_most(result: Result) -> None:
    run = replace(result, static_wheel_load_N=(100.0, 100.0, 50.0, 100.0), min_wheel_load_N=(90.0, 80.0, 30.0, 95.0))
    assert run.max_wheel_unloading == pytest.approx(0.4)


def test_time_per_step(result: Result) -> None:
    assert replace(result, steps=200, solve_seconds=0.1).microseconds_per_step == pytest.approx(500.0)


def test_frame_has_time_as_index_and_the_channels_as_columns(result: Result) -> None:
    frame = result.to_frame()
    assert frame.index.name == "time"
    assert list(frame.columns) == list(result.channels)
    np.testing.assert_array_equal(frame["speed"].to_numpy(), result.channels["speed"])


def test_nothing_in_a_result_can_be_changed(result: Result) -> None:
    with pytest.raises(FrozenInstanceError):
        result.steps = 1  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        result.channels["speed"][0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        result.time[0] = 1.0


def test_the_caller_keeps_the_right_to_its_own_array(result: Result) -> None:
    time = result.time.copy()
    replace(result, time=time)
    time[0] = 0.0


def test_a_channel_of_another_length_is_refused(result: Result) -> None:
    with pytest.raises(ValueError, match="'speed' must have shape"):
        replace(result, channels={"speed": np.zeros(3)})


def test_an_unknown_channel_is_refused(result: Result) -> None:
    with pytest.raises(KeyError, match="sped"):
        replace(result, channels={"sped": result.time})


def test_an_unknown_status_is_refused(result: Result) -> None:
    with pytest.raises(ValueError, match="derailed"):
        replace(result, status="derailed")  # type: ignore[arg-type]


def test_a_status_given_as_text_becomes_one(result: Result) -> None:
    assert replace(result, status="pitch-limit").status is Status.PITCH_LIMIT  # type: ignore[arg-type]


def test_every_status_but_stopped_tells_the_remedy() -> None:
    assert [status for status in Status if not status.remedy] == [Status.STOPPED]


def test_a_result_survives_pickling(result: Result) -> None:
    copy = pickle.loads(pickle.dumps(result))
    assert copy.summary() == result.summary()
    np.testing.assert_array_equal(copy.channels["wheel_1_normal_force"], result.channels["wheel_1_normal_force"])
