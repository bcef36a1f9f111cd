"""Any object can be an argument: invalid ones are rejected and change nothing, nothing panics, and
no result is NaN.

With more examples: ``python -m pytest --hypothesis-profile=long tests/test_anything.py``.
"""

import contextlib

import acrobot_rs
import gymnasium
import numpy as np
from acrobot_rs import LogUniform, Normal, Uniform
from acrobot_rs.swingup import Swingup
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from vectors import SINGLE_KINDS

#: What a call may raise. A panic in Rust raises none of these.
REJECTIONS = (
    *(AssertionError, AttributeError, OverflowError, TypeError, ValueError),
    gymnasium.error.Error,
)

BORDERS = [2**63, 2**64 - 1, -(2**63), 10**400, 1e300, 3.5e38, 5e-324, -0.0]
NUMBERS = st.one_of(
    *(st.integers(0, 2), st.integers(), st.floats(), st.floats(0.01, 10.0), st.booleans()),
    st.sampled_from(BORDERS),
    *(arrays.from_dtype(np.dtype(each)) for each in (np.int64, np.float32)),
)
INTEGERS = arrays.integer_dtypes() | arrays.unsigned_integer_dtypes()
ARRAYS = arrays.arrays(
    INTEGERS | arrays.floating_dtypes() | arrays.boolean_dtypes(),
    arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
)
TEXTS = st.text(st.characters(), max_size=9) | st.binary(max_size=9)
BOUND = st.sampled_from(["low", "high"])
ANYTHING = st.recursive(
    NUMBERS | ARRAYS | st.none() | TEXTS | st.builds(object),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(BOUND, inner),
    max_leaves=4,
)
NAMES = st.sampled_from(tuple(dict.fromkeys((*acrobot_rs.AcrobotEnv._NAMES, *Swingup._NAMES))))
TORQUES = st.lists(NUMBERS, min_size=3, max_size=3)
VALUES = st.one_of(NUMBERS, TORQUES, st.sampled_from(["book", "nips"]), ANYTHING)
#: Also valid ones.
BOUNDS = (
    st.lists(NUMBERS | TORQUES, min_size=2, max_size=4)
    | st.just([0.5, 1.5])
    | st.just([1.0, 0.1, 0.5, 1.5])
)
DRAWN = st.builds(
    lambda kind, args: attempt(kind, *args), st.sampled_from([Uniform, LogUniform, Normal]), BOUNDS
)
MANY = st.one_of(VALUES, st.lists(VALUES, max_size=4), DRAWN)
MASKS = st.lists(st.booleans(), max_size=4) | ARRAYS
STATES = st.lists(NUMBERS, min_size=4, max_size=4)
KEYS = st.sampled_from(["low", "high", "reset_mask", "state", "state"]) | st.text() | st.integers()
OPTIONS = st.none() | st.dictionaries(
    KEYS, MASKS | NUMBERS | STATES | st.lists(STATES, max_size=4) | ANYTHING
)
MODES = st.sampled_from(["NextStep", "SameStep", "Disabled"])
SEEDS = st.none() | st.integers(0, 2**200) | ANYTHING
FEW = st.integers(1, 4)


def attempt(function, *args, **kwargs):
    try:
        return function(*args, **kwargs)
    except REJECTIONS:
        return None


def calls(seeds, values, states, *others):
    """Sequences of calls, each a function and its arguments after the environment."""
    functions = (
        (lambda env, seed, options: env.reset(seed=seed, options=options)[0], seeds, OPTIONS),
        (setattr, NAMES, values),
        (setattr, st.just("state"), states),
        (lambda env: env.render_mode and env.render(),),
        *others,
    )
    return st.lists(
        st.one_of([st.tuples(st.just(function), *arguments) for function, *arguments in functions]),
        max_size=20,
    )


def play(env, sequence):
    """Makes the calls of a sequence and checks the observations that they return."""
    for function, *arguments in sequence:
        before = env._native.__getstate__()
        try:
            result = function(env, *arguments)
        except REJECTIONS:
            assert env._native.__getstate__() == before, "a rejected call changed something"
            continue
        if isinstance(result, np.ndarray):
            assert not np.isnan(result).any()
        if env.state is not None:
            assert np.isfinite(env.state).all()


def set_element(env, index, value):
    """A wrong number is rejected by what reads it first."""
    if env.state is not None:
        before = env.state[index]
        with contextlib.suppress(RuntimeWarning):
            env.state[index] = value
        try:
            env._native.__getstate__()
        except ValueError:
            env.state[index] = before
            raise


@given(
    st.sampled_from(SINGLE_KINDS),
    st.sampled_from([None, "ansi", "ansi", "ansi", "rgb_array"]),
    calls(
        *(SEEDS, VALUES, STATES | ANYTHING),
        (set_element, st.integers(0, 3), NUMBERS | ANYTHING),
        (
            lambda env, action: env.step(action)[0],
            st.integers(0, 2) | ANYTHING | st.lists(NUMBERS, min_size=1, max_size=1) | ARRAYS,
        ),
    ),
)
def test_a_single_environment(kind, mode, sequence):
    play(kind(mode), sequence)


@given(
    *(FEW, FEW, MODES, st.booleans(), st.sampled_from([False, True, None])),
    calls(
        *(SEEDS | st.lists(SEEDS, max_size=4), MANY),
        st.lists(STATES, max_size=4) | ANYTHING,
        (acrobot_rs.AcrobotVectorEnv.set_attr, NAMES | st.just("state") | st.text(), MANY),
        (
            lambda envs, action: envs.step(np.full(envs.action_space.shape, action))[0],
            st.integers(0, 2),
        ),
        (
            lambda envs, actions: envs.step(actions)[0],
            st.lists(st.integers(0, 2), max_size=4) | ARRAYS | ANYTHING,
        ),
    ),
)
def test_a_vector_environment(num_envs, limit, autoreset, copy, gymnasium_episodes, sequence):
    arguments = (num_envs, limit, "ansi", autoreset, copy)
    if gymnasium_episodes is None:
        play(acrobot_rs.AcrobotSwingupVectorEnv(num_envs, limit, copy=copy), sequence)
    else:
        play(acrobot_rs.AcrobotVectorEnv(*arguments, gymnasium_episodes), sequence)


@given(FEW | ANYTHING, FEW | ANYTHING, ANYTHING, MODES | ANYTHING)
def test_constructors(num_envs, limit, mode, autoreset):
    # A large number of environments would need too much memory.
    if not isinstance(num_envs, int | np.integer) or num_envs < 1000:
        attempt(acrobot_rs.AcrobotVectorEnv, num_envs, limit, mode, autoreset)
    attempt(acrobot_rs.AcrobotEnv, mode)


def damaged(good):
    """Snapshots with bytes removed, changed or added, and random bytes."""
    change = st.tuples(st.integers(0, len(good) - 1), st.integers(1, 255))

    def apply(changes, end, more):
        bad = bytearray(good)
        for index, difference in changes:
            bad[index] ^= difference
        return bytes(bad[:end]) + more

    ends = st.just(len(good)) | st.integers(0, len(good))
    return (
        st.builds(apply, st.lists(change, max_size=4), ends, st.just(b"") | st.binary(max_size=4))
        | st.binary()
    )


def played(env):
    """An environment after a step."""
    env.reset(seed=1)
    env.step(env.action_space.sample())
    return env


SINGLES = played(acrobot_rs.AcrobotEnv())._native.__getstate__()
BATCHES = played(
    acrobot_rs.AcrobotVectorEnv(2, 1, autoreset_mode="SameStep", dt=LogUniform(0.1, 0.2))
)._native.__getstate__()


@given(
    st.tuples(st.just(acrobot_rs.AcrobotEnv), damaged(SINGLES))
    | st.tuples(st.just(acrobot_rs.AcrobotVectorEnv), damaged(BATCHES))
)
def test_damaged_snapshots(kind_and_snapshot):
    kind, snapshot = kind_and_snapshot
    env = played(kind())
    before = env._native.__getstate__()
    try:
        env._native.__setstate__(snapshot)
    except ValueError:
        assert env._native.__getstate__() == before
    if kind is acrobot_rs.AcrobotEnv and env.state is not None:
        # With continuous torques, 1 is no action.
        if result := attempt(env.step, 1):
            assert not np.isnan(result[0]).any()
    elif kind is acrobot_rs.AcrobotVectorEnv:
        count = len(env._native)
        vars(env)["num_envs"] = count
        observations, finals = np.zeros((2, count, 6), np.float32)
        attempt(env._native.step, env, np.ones(count, np.int64), observations, finals)
        assert not np.isnan(observations).any()
        assert np.isfinite(env.state).all()
    env._native.render(*([] if kind is acrobot_rs.AcrobotEnv else [0]), "ansi")
