"""Invalid calls raise an error that names the argument, the rule and the value, and change nothing.

`test_recorded.py` has the rules of all packages, and `test_anything.py` passes any object.
"""

import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceVectorEnv, AcrobotContinuousEnv, AcrobotContinuousVectorEnv
from acrobot_rs import AcrobotEnv, AcrobotSwingupEnv, AcrobotSwingupVectorEnv, AcrobotVectorEnv
from acrobot_rs import LogUniform, Normal, Uniform
from acrobot_rs._native import Acrobot
from gymnasium.error import Error, InvalidAction, ResetNeeded
from vectors import KINDS, make_vec, rejects

SINGLE, SWINGUP = AcrobotEnv(torque_noise_max=0.5, AVAIL_TORQUE=[-1, 0, 1, 2]), AcrobotSwingupEnv()
TORQUE = AcrobotContinuousEnv()
VECTORS = MANY, OWN, DRAWN = [
    make_vec(3, LINK_MOI=0.0, LINK_MASS_1=mass, gymnasium_episodes=is_gymnasiums)
    for mass, is_gymnasiums in [(1.0, False), ([1.0, 1.5, 2.0], False), (Uniform(1.0, 2.0), True)]
]
TORQUES, SWINGUPS = AcrobotContinuousVectorEnv(3), AcrobotSwingupVectorEnv(3)
DISABLED = make_vec(3, autoreset_mode="Disabled", max_episode_steps=1)
for each in (SINGLE, SWINGUP, TORQUE, *VECTORS, TORQUES, SWINGUPS, DISABLED):
    each.reset(seed=1)
DISABLED.step([0, 1, 2])
DISABLED.reset(options={"reset_mask": np.array([True, False, True])})
SNAPSHOT = SINGLE._native.__getstate__()
FOUR, NOISE = b"\4" + np.array([-1.0, 0.0, 1.0, 2.0]).tobytes(), np.float64(0.5).tobytes()


def step(env, action):
    env.step(action)


def render(env, _):
    env.render()


def seed(env, seed):
    env.reset(seed=seed)


def options(env, options):
    env.reset(seed=2, options=options)


def state(env, state):
    env.reset(seed=2, options={"state": state})


def reset_mask(env, mask):
    env.reset(seed=2, options={"reset_mask": mask})


def snapshot(env, snapshot):
    env._native.__setstate__(snapshot)


UNREADY, OTHERS = AcrobotVectorEnv(render_mode="ansi"), FOUR + FOUR[1:9]
RANGE, BEYOND = "in the range of float32, from 1.2e-38 to 3.4e38", [[0.0] * 4] * 2 + [[1e39] * 4]
#: Environments, a call or what is set, the error, invalid values, and the rule or, from ^ on, all.
CASES = [
    ([SINGLE], step, InvalidAction, [4, -1, 2**70, np.array([1]), np.timedelta64(1)], "an integer"),
    ([SINGLE], step, InvalidAction, [1.0, None, [np.nan]], "an integer from 0 to 3"),
    ([TORQUE], step, InvalidAction, [np.float32(1), ["1"], [[1.0]], [np.nan]], "a torque in N m"),
    ([TORQUE], step, InvalidAction, [[10**400], [[1], [2, 3]]], r"as an array of shape \(1,\)"),
    ([SWINGUP], step, InvalidAction, [[np.nan], 1.0, None], "a number from -1 to 1, as an array"),
    (VECTORS, step, InvalidAction, [[0, 1], [0.0, 1.0, 2.0], 1, [True] * 3], "integers of shape"),
    (VECTORS, step, InvalidAction, [[0, 1, 2**32]], r"0 \(negative torque\), 1 \(none\) or 2"),
    ([TORQUES], step, InvalidAction, [[[0.5]], [0.5] * 3, [["0"]] * 3], r"numbers of shape \(3, 1"),
    ([TORQUES], step, InvalidAction, [np.zeros((3, 1), object)], r"numbers of shape \(3, 1\)"),
    ([TORQUES], step, InvalidAction, [[[0.0], [np.nan], [0.0]]], "a number, N m, got NaN"),
    ([SWINGUPS], step, InvalidAction, [[[0.0], [np.nan], [0.0]]], "a number from -1 to 1, got NaN"),
    ([SINGLE, MANY, DRAWN], seed, Error, [-1, "4", 4.0, np.True_], "an integer of at least 0"),
    ([MANY, DRAWN], seed, Error, [[1, 2, "4"]], "an integer of at least 0, got '4'"),
    ([MANY, DRAWN], seed, ValueError, [[1], (1,) * 4], "^seed must have one element for each of 3"),
    ([MANY, DRAWN], seed, ValueError, [10**5000], "^Exceeds the limit"),
    ([SINGLE, MANY], options, TypeError, [5], "a dict, got 5"),
    ([SINGLE], state, ValueError, [[1.0] * 3, None, [np.nan] * 4, [1e39] * 4], "range of float32"),
    ([SINGLE], "state", ValueError, [[1, 2, 3], None, [True] * 4], "four finite numbers"),
    ([MANY, DRAWN], state, ValueError, [[1.0] * 3, [[1.0] * 4] * 2, None], r"of shape \(3, 4\)"),
    ([MANY, DRAWN], "state", ValueError, [[1, 2, 3], None], r"numbers of shape \(3, 4\) or \(4,\)"),
    ([MANY, DRAWN], state, ValueError, [BEYOND], f"{RANGE}, got 1e39"),
    ([MANY], "state", ValueError, [BEYOND], f"{RANGE}, got 1e39"),
    ([MANY], reset_mask, ValueError, [None, [1, 0, 0], [False] * 3], "an array of bool of shape"),
    ([MANY], reset_mask, ValueError, [True, [True], [[True] * 3]], "with a true element, got"),
    ([SINGLE], "AVAIL_TORQUE", ValueError, [[]], "one or more numbers of N m"),
    ([SINGLE], "AVAIL_TORQUE", TypeError, [{1.0, 2.0}], "a sequence of numbers"),
    (VECTORS, "AVAIL_TORQUE", ValueError, [[-1, 1]], r"3 numbers, such as \[-2, 0, 2\], got 2"),
    (VECTORS, "AVAIL_TORQUE", ValueError, [[[1, 2, 3], [1, 2], [1, 2, 3]]], "3 numbers, .* got 2"),
    (VECTORS, "AVAIL_TORQUE", TypeError, [Uniform(0, 1)], "a sequence of 3 numbers, got 0"),
    ([MANY], "AVAIL_TORQUE", ValueError, [Uniform([-1] * 3, [0, 1e300, 1])], f"{RANGE}, got 1e300"),
    ([SINGLE, MANY], "book_or_nips", ValueError, ["b"], "'book' or 'nips', got 'b'"),
    ([SINGLE, MANY], "book_or_nips", TypeError, [None, Uniform(0, 1)], "'book' or 'nips', got"),
    (VECTORS, "book_or_nips", ValueError, [["book", "nips", "b"]], "'book' or 'nips', got 'b'"),
    ([SINGLE], "LINK_MASS_1", TypeError, [Uniform(1.0, 2.0)], "a number, got Uniform"),
    (VECTORS, "LINK_MASS_1", TypeError, [[1, 2, None]], "a number, got None"),
    (VECTORS, "LINK_MASS_1", ValueError, [[1, 2]], "one for each of 3 environments, .* 2 values"),
    ([MANY, OWN], "LINK_MASS_1", ValueError, [[1.0, 1e-300, 1.0]], f"{RANGE}, got 1e-300"),
    ([MANY, OWN], "LINK_MASS_1", ValueError, [Uniform(0.4, 0.3)], "a low of at most .* got 0.4$"),
    ([MANY, OWN], "gravity", ValueError, [Normal(9, 1e300, 8, 10)], f"{RANGE}, got 1e300"),
    ([MANY, DRAWN], "LINK_MOI_1", TypeError, [None], "a number, got None"),
    ([MANY, DRAWN], "LINK_MOI", TypeError, [Uniform(1, 2)], "a number; a reset .* LINK_MOI_2"),
    (VECTORS, "LINK_COM_POS_2", ValueError, [Uniform(0, 1)], "^LINK_MOI_2 must be above 0 if"),
    ([MANY, TORQUES], "elapsed_steps", AttributeError, [1.0], "^.*elapsed_steps"),
    ([AcrobotEnv()], step, AssertionError, [0], "^.* no state yet; call reset before step"),
    ([AcrobotSwingupEnv()], step, ResetNeeded, [[0]], "^.* no state yet; call reset before step"),
    ([AcrobotVectorEnv()], step, ResetNeeded, [[0]], "^.* no states yet; call reset before step"),
    ([UNREADY], render, ResetNeeded, [0], "^.* no states yet; call reset before render"),
    ([DISABLED], step, ResetNeeded, [[0] * 3], "^the episode of environment 1 has ended; reset it"),
    ([SINGLE], snapshot, ValueError, [SNAPSHOT[:-1]], "^the snapshot is damaged: "),
    ([SINGLE], snapshot, ValueError, [b"\0" + SNAPSHOT[1:]], "^the snapshot is of another version"),
    ([SINGLE], snapshot, ValueError, [SNAPSHOT.replace(FOUR, b"\0")], "^AVAIL_TORQUE must be one"),
    ([SINGLE], snapshot, ValueError, [SNAPSHOT.replace(FOUR + NOISE, OTHERS)], "^torque_noise"),
]


@pytest.mark.parametrize(("envs", "call", "error", "values", "rule"), CASES)
def test_a_rejected_call_changes_nothing(envs, call, error, values, rule):
    name = call if isinstance(call, str) else call.__name__.replace("step", "actions?")
    message = rule if rule[0] == "^" else rf"^{name}(\[[\d, ]+\])? must be .*{rule}"
    for env in envs:
        for value in values:
            with rejects(env, error, message):
                setattr(env, call, value) if call is name else call(env, value)


@pytest.mark.parametrize(
    ("kind", "name", "value"),
    [
        *((AcrobotVectorEnv, "num_envs", count) for count in (0, -1, 2**40, 2.0, "2")),
        *((AcrobotVectorEnv, name, 0) for name in ("max_episode_steps", "threads")),
        *((kind, "render_mode", "human") for kind in (AcrobotEnv, AcrobotVectorEnv)),
        *((kind, "gymnasium_episodes", True)
          for kind in (AcrobotSwingupVectorEnv, AcrobotBalanceVectorEnv)),
        (lambda **others: AcrobotVectorEnv(gymnasium_episodes=True, **others), "float64", True),
        (Acrobot, "task", "x"),
    ],
)  # fmt: skip
def test_invalid_arguments_are_rejected(kind, name, value):
    with pytest.raises(ValueError, match=f"^{name} must be .*, got "):
        kind(**{name: value})


@pytest.mark.parametrize("kind", KINDS)
def test_an_unknown_name_is_rejected(kind):
    env = kind()
    with pytest.raises(AttributeError, match="no attribute 'mass_1'; .*, LINK_MASS_1, "):
        env.mass_1 = 2.0
    # In Python's words, which torchrl recognises.
    words = rf"{kind.__name__}.__init__\(\) got an unexpected keyword argument 'mass_1'"
    with pytest.raises(TypeError, match=f"{words}; .*, LINK_MASS_1, "):
        kind(mass_1=2.0)
    # What Gymnasium and users set, also in their own classes.
    env.np_random, env.render_mode = np.random.default_rng(1), "ansi"
    env.metadata, env.spec = {**env.metadata}, None
    type("Own", (kind,), {})().curriculum_level = 3


class Mixin:
    def _terminal(self):
        return False


@pytest.mark.parametrize("kind", KINDS)
def test_a_method_that_only_gymnasium_calls_is_rejected(kind):
    with pytest.raises(TypeError, match=r"^Own\._dsdt has no effect here; set parameters, such as"):
        type("Own", (kind,), {"_dsdt": lambda self, s: s})
    with pytest.raises(TypeError, match=r"^Own\._terminal has no effect here; override step"):
        type("Own", (Mixin, kind), {})


def test_environments_that_do_not_fit_into_memory_are_rejected():
    """In a process that may use 64 GB: these need 400 GB."""
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (2**36, limits[1]))
    try:
        with pytest.raises(MemoryError, match="num_envs must be so few that they fit into memory"):
            AcrobotVectorEnv(2**32 - 1)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)
