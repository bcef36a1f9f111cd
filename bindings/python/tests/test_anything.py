"""Any object can be an argument: invalid ones are rejected and change nothing, nothing panics, and
no result is NaN. Copies and pickles continue bit-identically, and share nothing.

With more examples: ``python -m pytest --hypothesis-profile=long tests/test_anything.py``.
"""

import copy
import pickle

import acrobot_rs
import gymnasium
import numpy as np
from acrobot_rs import LogUniform, Normal, Uniform
from acrobot_rs.swingup import Swingup
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from vectors import KINDS, SINGLE_KINDS

#: What a call may raise. A panic in Rust raises none of these.
REJECTIONS = (
    *(AssertionError, AttributeError, OverflowError, TypeError, ValueError, RuntimeWarning),
    gymnasium.error.Error,
)

BORDERS = [2**63, 2**64 - 1, -(2**63), 10**400, 1e300, 3.5e38, 5e-324, -0.0]
NUMBERS = st.one_of(
    *(st.integers(0, 2), st.integers(), st.floats(), st.floats(0.01, 10.0), st.booleans()),
    st.sampled_from(BORDERS),
    *(arrays.from_dtype(np.dtype(each)) for each in (np.int64, np.float32)),
)
ARRAYS = arrays.arrays(
    arrays.integer_dtypes() | arrays.floating_dtypes() | arrays.boolean_dtypes(),
    arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
)
ANYTHING = st.recursive(
    NUMBERS | ARRAYS | st.none() | st.text() | st.binary() | st.builds(object),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner),
    max_leaves=4,
)
NAMES = st.sampled_from(tuple(dict.fromkeys((*acrobot_rs.AcrobotEnv._ALL, *Swingup._ALL))))
TORQUES = st.lists(NUMBERS, min_size=3, max_size=3)
VALUES = st.one_of(NUMBERS, TORQUES, st.sampled_from(["book", "nips"]), ANYTHING)
DRAWN = st.one_of(
    *(st.builds(kind, VALUES, VALUES) for kind in (Uniform, LogUniform)),
    st.builds(Normal, VALUES, VALUES, VALUES, VALUES),
    st.sampled_from([LogUniform(0.5, 1.5), Normal(1.0, 0.1, 0.5, 1.5)]),
)
MANY = st.one_of(VALUES, st.lists(VALUES, max_size=4), DRAWN)
STATES = st.lists(NUMBERS, min_size=4, max_size=4)
KEYS = st.sampled_from(["low", "high", "reset_mask", "state", "state"])
OPTIONS = st.none() | st.dictionaries(
    KEYS, st.lists(st.booleans()) | NUMBERS | STATES | st.lists(STATES, max_size=4) | ANYTHING
)
AGAIN = st.sampled_from([
    *(copy.copy, copy.deepcopy),
    *(lambda env, p=p: pickle.loads(pickle.dumps(env, p)) for p in (0, pickle.HIGHEST_PROTOCOL)),
])  # fmt: skip
VECTOR_KINDS = [kind for kind in KINDS if kind not in SINGLE_KINDS]
OTHERS = [
    (acrobot_rs.AcrobotVectorEnv, {name: value})
    for name, value in (("copy", False), ("gymnasium_episodes", True), ("float64", True))
]
SEEDS = st.none() | st.integers(0, 2**200) | ANYTHING


def calls(seeds, values, states, actions, *others):
    """Sequences of calls, each a function and its arguments after the environment."""
    functions = (
        (lambda env, seed, options: env.reset(seed=seed, options=options)[0], seeds, OPTIONS),
        (lambda env, action: env.step(action)[0], actions),
        (setattr, NAMES, values),
        (setattr, st.just("state"), states),
        (lambda env: env.render_mode and env.render(),),
        *others,
    )
    return st.lists(
        st.one_of([st.tuples(st.just(function), *arguments) for function, *arguments in functions]),
        max_size=20,
    )


def play(env, sequence, again):
    """Makes the calls of a sequence, the second half of them also to a copy, with equal results."""
    env.np_random = np.random.default_rng(1)
    env.action_space.seed(1)
    envs = [env]
    for index, (function, *arguments) in enumerate(sequence):
        if index == len(sequence) // 2:
            envs = [again(env), env]
        results = []
        for each in envs:
            before = each._native.__getstate__()
            try:
                result = function(each, *arguments)
            except REJECTIONS as error:
                assert each._native.__getstate__() == before, "a rejected call changed something"
                result = type(error)
            if isinstance(result, np.ndarray):
                assert not np.isnan(result).any()
            if each.state is not None:
                assert np.isfinite(each.state).all()
            results.append([result, each._native.__getstate__(), each.parameters])
        np.testing.assert_equal(results[0], results[-1])
    samples = [each.action_space.sample() for each in envs]
    np.testing.assert_equal(samples[0], samples[-1])


@given(
    *(AGAIN, st.sampled_from(SINGLE_KINDS)),
    st.sampled_from([None, "ansi", "ansi", "ansi", "rgb_array"]),
    calls(
        *(SEEDS, VALUES, STATES | ANYTHING),
        st.integers(0, 2) | ANYTHING | st.lists(NUMBERS, min_size=1, max_size=1) | ARRAYS,
    ),
)
def test_a_single_environment(again, kind, mode, sequence):
    play(kind(mode), sequence, again)


@given(
    *(AGAIN, st.integers(1, 4), st.integers(1, 4)),
    st.sampled_from(["NextStep", "SameStep", "Disabled"]),
    st.sampled_from([(kind, {}) for kind in VECTOR_KINDS] + OTHERS),
    calls(
        *(SEEDS | st.lists(SEEDS, max_size=4), MANY, st.lists(STATES, max_size=4) | ANYTHING),
        st.lists(st.integers(0, 2), max_size=4) | ARRAYS | ANYTHING,
        (acrobot_rs.AcrobotVectorEnv.set_attr, NAMES | st.just("state"), MANY),
        (
            lambda envs, action: envs.step(np.full(envs.action_space.shape, action))[0],
            st.integers(0, 2),
        ),
    ),
)
def test_a_vector_environment(again, num_envs, limit, autoreset, made, sequence):
    kind, others = made
    arguments = {"render_mode": "ansi", "autoreset_mode": autoreset, **others}
    play(kind(num_envs, limit, **arguments), sequence, again)
