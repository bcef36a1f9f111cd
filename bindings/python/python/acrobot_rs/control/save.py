"""Plans, gains and parameters as constants of Rust and C."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from acrobot_rs import _native
from acrobot_rs.arrays import float32, must_be, numbers
from acrobot_rs.control.model import Env, acrobot_of
from acrobot_rs.control.plan import Plan, Region, rows_of
from acrobot_rs.env import AcrobotEnv

#: What the constants of Rust need.
_USES = """\
use acrobot::State;
use acrobot::control::plan::{Knot, Plan};
use acrobot::control::regulator::{Feedback, Region};

#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "numbers of the plan")]
"""


def save(
    path: str | Path,
    *,
    plan: Plan | None = None,
    gain: ArrayLike | None = None,
    params: Mapping[str, Any] | Env = None,
) -> None:
    """Write constants in ``float32`` for firmware: of Rust if the name ends in .rs, of C for .h.

    Args:
        path: The file.
        plan: ``PLAN`` in Rust, and in C ``KNOTS`` and ``AFTER``.
        gain: ``GAIN``: K in u = -K x, N m per rad and per rad/s, of shape ``(4,)`` or ``(1, 4)``.
        params: ``PARAMS``: an environment, or arguments of one, such as ``Fit.params``.
    """
    is_rust = str(path).endswith(".rs")
    if not (is_rust or str(path).endswith(".h")):
        raise must_be("path", "a file that ends in .rs or .h", repr(path))
    code = "// Written by acrobot_rs.control.save in Python.\n"
    if plan is not None:
        rows_of("plan", plan)
        code += f"// {1 / plan.dt:g} decisions a second.\n"
        code += _rust_plan(plan) if is_rust else _c_plan(plan)
    if gain is not None:
        rule = "numbers of shape (4,) or (1, 4)"
        shape = (1, 4) if numbers("gain", rule, gain, None).ndim == 2 else (4,)
        k = _list(np.ravel(float32("gain", rule, gain, shape)))
        code += "\n// K in u = -K x, N m per rad and per rad/s.\n"
        code += f"pub const GAIN: [f32; 4] = [{k}];\n" if is_rust else _c("float GAIN[4]", k)
    if params is not None:
        env = AcrobotEnv(**params) if isinstance(params, Mapping) else params
        code += _params(acrobot_of(env, "params"), is_rust)
    Path(path).write_text(code)


def _number(x: float) -> str:
    """A ``float32`` as Rust prints it."""
    x = np.float32(x)
    if x == 0 or 1e-5 <= abs(x) < 1e16:
        return np.format_float_positional(x, trim="0")
    return np.format_float_scientific(x, trim="-", exp_digits=1).replace("+", "")


def _list(numbers: Iterable[float]) -> str:
    return ", ".join(map(_number, numbers))


def _rust_plan(plan: Plan) -> str:
    def region(each: Region) -> str:
        rows = "".join(f"        [{_list(row)}],\n" for row in each.factor)
        return f"Region {{ gain: [{_list(each.gain)}], factor: [\n{rows}    ] }}"

    knots = "".join(
        f"    Knot::new([{_list(state)}], {_number(torque)},\n        [{_list(gain)}]),\n"
        for state, torque, gain in zip(plan.states, plan.torques, plan.gains)
    )
    # 0.0 makes 0 of -0.
    after, names = plan.after, ("theta1", "theta2", "dtheta1", "dtheta2")
    target = ", ".join(f"{name}: {_number(x)}" for name, x in zip(names, after.target))
    return (
        f"{_USES}pub const PLAN: Plan<f32, [Knot<f32>; {len(plan)}]> = Plan {{\n"
        f"knots: [\n{knots}],\nafter: Feedback {{\n    target: State {{ {target} }},\n"
        f"    torque: {_number(after.torque + 0.0)},\n    moving: {region(after.moving)},\n"
        f"    resting: {region(after.resting)},\n    reach: {_number(after.reach)},\n}},\n}};\n"
    )


def _c(declaration: str, body: str) -> str:
    return f"static const {declaration} = {{{body}}};\n"


def _c_plan(plan: Plan) -> str:
    def region(each: Region) -> str:
        rows = "".join(f"        {{{_list(row)}}},\n" for row in each.factor)
        return f"    {{{{{_list(each.gain)}}}, {{\n{rows}    }}}},\n"

    knots = "".join(
        f"    {{{{{_list(state)}}}, {_number(torque)},\n     {{{_list(gain)}}}, {{0, 0}}}},\n"
        for state, torque, gain in zip(plan.states, plan.torques, plan.gains)
    )
    after = plan.after
    body = f"\n    {{{_list(after.target)}}}, {_number(after.torque + 0.0)},\n"
    body += f"{region(after.moving)}{region(after.resting)}    {_number(after.reach)},\n"
    knots = _c(f"acrobot_knot_t KNOTS[{len(plan)}]", f"\n{knots}")
    return knots + _c("acrobot_feedback_t AFTER", body)


def _params(env: AcrobotEnv, is_rust: bool) -> str:
    numbers = {name: _number(x) for name, x in _native.fields(env._native)}
    torques = ", ".join(numbers.pop(f"torques[{i}]") for i in range(3))
    dynamics = str(env.book_or_nips)
    if is_rust:
        dynamics = f"acrobot::physics::Dynamics::{dynamics.capitalize()}"
        fields = numbers | {"torques": f"[{torques}]", "dynamics": dynamics}
        lines = "".join(f"    {name}: {x},\n" for name, x in fields.items())
        return f"\npub const PARAMS: acrobot::Params<f32> = acrobot::Params {{\n{lines}}};\n"
    lines = "\n"
    for name, x in numbers.items():
        x = f"{{{torques}}}, {x}" if name == "torque_noise" else x
        lines += f"    {x}, // {name}\n"
    lines += f"    ACROBOT_DYNAMICS_{dynamics.upper()},\n"
    return "\n" + _c("acrobot_params_t PARAMS", lines)
