"""Answers that change need a new RESULT_VERSION: a journal must not mix old stops with new ones."""

from typing import Any

import pytest

from slosh_cli.scenario import Scenario
from slosh_cli.study.key import RESULT_VERSION, history_key, stop_key
from slosh_cli.study.outcome import solve
from slosh_cli.study.plan import Stop

ACCURACY = 2e-4
"""What the default tolerance promises, and a little; a change within it is none."""

# key path -> value, braking distance in m with solver.tolerance 1e-6
ANSWERS: dict[int, list[tuple[dict[str, Any], float]]] = {
    1: [
        ({"braking.torque": "2.5 kN m"}, 430.0477),
        ({"tank.coefficients": "computed"}, 218.4000),
        ({"tank.liquid.model": "rigid"}, 218.5250),
        ({"tank.liquid.model": "rigid", "braking.torque": "15 kN m", "contact.adhesion": "wet"}, 182.9485),
    ],
    2: [  # steps and slopes of the shallow-water liquid are others
        ({"braking.torque": "2.5 kN m"}, 430.0477),
        ({"tank.coefficients": "computed"}, 218.4000),
        ({"tank.liquid.model": "rigid"}, 218.5250),
        ({"tank.liquid.model": "rigid", "braking.torque": "15 kN m", "contact.adhesion": "wet"}, 182.9485),
        ({"tank.liquid.model": "shallow-water", "braking.torque": "10 kN m"}, 120.8951),
        (
            {
                "tank.liquid.model": "shallow-water",
                "braking.torque": "10 kN m",
                "tank.baffles": [{"position": "5 m", "opening": 0.2}],
            },
            117.8736,
        ),
    ],
    3: [  # bouncing wheels on undamped tracks are refused, light wagons are coupled to their liquid tightly
        ({"braking.torque": "2.5 kN m"}, 430.0477),
        ({"tank.coefficients": "computed"}, 218.4000),
        ({"tank.liquid.model": "rigid"}, 218.5250),
        ({"tank.liquid.model": "rigid", "braking.torque": "15 kN m", "contact.adhesion": "wet"}, 182.9485),
        ({"tank.liquid.model": "shallow-water", "braking.torque": "10 kN m"}, 120.8943),
        (
            {
                "tank.liquid.model": "shallow-water",
                "braking.torque": "10 kN m",
                "tank.baffles": [{"position": "5 m", "opening": 0.2}],
            },
            117.8737,
        ),
    ],
    4: [  # baffles let through what flows under two levels
        ({"braking.torque": "2.5 kN m"}, 430.0477),
        ({"tank.coefficients": "computed"}, 218.4000),
        ({"tank.liquid.model": "rigid"}, 218.5250),
        ({"tank.liquid.model": "rigid", "braking.torque": "15 kN m", "contact.adhesion": "wet"}, 182.9485),
        ({"tank.liquid.model": "shallow-water", "braking.torque": "10 kN m"}, 120.8943),
        (
            {
                "tank.liquid.model": "shallow-water",
                "braking.torque": "10 kN m",
                "tank.baffles": [{"position": "5 m", "opening": 0.2}],
            },
            118.2751,
        ),
        (
            {
                "tank.liquid.model": "shallow-water",
                "braking.torque": "10 kN m",
                "tank.baffles": [{"position": "5 m", "openings": [{"from": "0 m", "to": "0.6 m"}]}],
            },
            119.4836,
        ),
    ],
}


@pytest.mark.parametrize("number", range(len(ANSWERS[RESULT_VERSION])))
def test_answers_are_those_of_this_result_version(paper: Scenario, number: int) -> None:
    changes, distance = ANSWERS[RESULT_VERSION][number]
    scenario = paper.with_(changes)
    found = solve(Stop(0, "", scenario)).answer["braking_distance_m"]
    assert found == pytest.approx(distance, rel=ACCURACY), "raise RESULT_VERSION and add its answers here"


@pytest.mark.parametrize("model", ["rigid", "modal", "shallow-water"])
def test_the_answer_does_not_depend_on_what_its_key_leaves_out(paper: Scenario, model: str) -> None:
    stop = paper.with_({"braking.torque": "10 kN m", "tank.liquid.model": model, "solver.tolerance": 1e-3})
    other = stop.with_({"output.interval": 0.1, "name": "another", "description": "of it"})
    assert stop_key(stop) == stop_key(other)
    assert history_key(stop) != history_key(other)
    assert solve(Stop(0, "", stop)).answer == solve(Stop(0, "", other)).answer


def test_the_liquid_of_a_real_stop_is_judged(paper: Scenario) -> None:
    strong = {"braking.torque": "10 kN m", "solver.tolerance": 1e-2}
    assert solve(Stop(0, "", paper.with_(strong))).answer["liquid_in_range"] is False
    assert solve(Stop(0, "", paper.with_(strong | {"tank.liquid.model": "rigid"}))).answer["liquid_in_range"] is True
    assert solve(Stop(0, "", paper.with_({"braking.torque": "2 kN m"}))).answer["liquid_in_range"] is True
