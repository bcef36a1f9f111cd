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
MANY, OWN, DRAWN = (
    make_vec(3, LINK_MOI=0.0, LINK_MASS_1=mass, gymnasium_episodes=is_gymnasiums)
    for mass, is_gymnasiums in [(1.0, False), ([1.0, 1.5, 2.0], False), (Uniform(1.0, 2.0), True)]
)
TORQUES, SWINGUPS = AcrobotContinuousVectorEnv(3), AcrobotSwingupVectorEnv(3)
DISABLED = make_vec(3, autoreset_mode="Disabled", max_episode_steps=1)
for each in (SINGLE, SWINGUP, TORQUE, MANY, OWN, DRAWN, TORQUES, SWINGUPS, DISABLED):
    each.reset(seed=1)
DISABLED.step([0, 1, 2])
DISABLED.reset(options={"reset_mask": np.array([True, False, True])})
SNAPSHOT = SINGLE._native.__getstate__()
FOUR, NOISE = b"\4" + np.array([-1.0, 0.0, 1.0, 2.0]).tobytes(), np.float64(0.5).tobytes()
WORDS = "environments have no states yet; call reset before "
BEYOND = [[0.0] * 4, [0.0] * 4, [0.0, 0.0, 0.0, 1e39]]
BOOLS = r"^reset_mask must be an array of bool of shape \(3,\) with a true element, got"
STATES = r"^state must be numbers of shape \(3, 4\) or \(4,\), got"
FLOAT32 = "must be in the range of float32, from 1.2e-38 to 3.4e38, got"



def step(env, action):
    env.step(action)


def seed(env, seed):
    env.reset(seed=seed)


def reset(env, options):
    env.reset(seed=2, options=options)


def restore(env, snapshot):
    env._native.__setstate__(snapshot)


#: Environments, a call, invalid values, and the error.
CASES = [
    ([SINGLE], step, [4, -1, 2**70, np.array([1]), np.timedelta64(1), 1.0, None, [np.nan]],
     InvalidAction, "^action must be an integer from 0 to 3, got "),
    ([TORQUE], step,
     [np.float32(1), ["1"], [[1.0]], np.float32([np.nan]), [10**400], [[1], [2, 3]], None],
     InvalidAction, r"^action must be a torque in N m, as an array of shape \(1,\), got "),
    ([SWINGUP], step, [[np.nan], 1.0],
     InvalidAction, r"^action must be a number from -1 to 1, as an array of shape \(1,\), got "),
    ([MANY, OWN, DRAWN], step, [[0, 1], [0.0, 1.0, 2.0], 1, [True] * 3],
     InvalidAction, r"^actions must be integers of shape \(3,\), got "),
    ([MANY, OWN, DRAWN], step, [[0, 1, 2**32]],
     InvalidAction, r"^actions\[2\] must be 0 .negative torque., 1 .none. or 2 .positive., got 4"),
    ([TORQUES], step, [[[0.5]], [0.5] * 3, [["0"]] * 3, np.zeros((3, 1), object)],
     InvalidAction, r"^actions must be numbers of shape \(3, 1\), got "),
    ([TORQUES], step, [[[0.0], [np.nan], [0.0]]],
     InvalidAction, r"^actions\[1\] must be a number, N m, got NaN"),
    ([SWINGUPS], step, [[[0.0], [np.nan], [0.0]]],
     InvalidAction, r"^actions\[1\] must be a number from -1 to 1, got NaN"),
    ([DISABLED], step, [[0] * 3], ResetNeeded, "^the episode of environment 1 has ended; reset"),
    ([AcrobotEnv()], step, [0], AssertionError, "call reset before step"),  # Gymnasium's error
    ([AcrobotSwingupEnv()], step, [[0]], ResetNeeded, "call reset before step"),
    ([AcrobotVectorEnv(3)], step, [[0] * 3], ResetNeeded, f"{WORDS}step"),
    ([AcrobotVectorEnv(3, render_mode="ansi")], lambda env, _: env.render(), [0], ResetNeeded, f"{WORDS}render"),
    ([SINGLE, MANY, DRAWN], seed, [-1, "4", 4.0, np.True_],
     Error, "^seed must be an integer of at least 0, got "),
    ([MANY, DRAWN], seed, [10**5000, [1, 2, "4"], [1], (1,) * 4], (ValueError, Error), "seed|limit"),
    ([SINGLE, MANY], reset, [5], TypeError, "^options must be a dict, got 5"),
    ([SINGLE, MANY], reset, [{"low": "a"}], ValueError, "^low must be a number, got 'a'"),
    ([SINGLE], reset, [{"state": each} for each in ([1.0] * 3, None, [np.nan] * 4, [1e39] * 4)],
     ValueError, "^state must be four finite numbers in the range of float32, got "),
    ([MANY, DRAWN], reset, [{"state": each} for each in ([1.0] * 3, [[1.0] * 4] * 2, None)],
     ValueError, STATES),
    ([MANY, DRAWN], reset, [{"state": BEYOND}], ValueError, rf"^state\[2, 3\] {FLOAT32} 1e39"),
    ([MANY], reset, [{"reset_mask": each} for each in (None, [1, 0, 0], True, [False] * 3)],
     ValueError, BOOLS),
    ([MANY], reset, [{"reset_mask": [True]}, {"reset_mask": [[True] * 3]}], ValueError, BOOLS),
    ([SINGLE], "state", [[1, 2, 3], None, [True] * 4], ValueError, "state must be four finite num"),
    ([MANY, DRAWN], "state", [[1, 2, 3], None], ValueError, STATES),
    ([MANY], "state", [BEYOND], ValueError, rf"^state\[2, 3\] {FLOAT32} 1e39"),
    ([SINGLE], "AVAIL_TORQUE", [[]], ValueError, "^AVAIL_TORQUE must be one or more numbers of N m"),
    ([SINGLE], "AVAIL_TORQUE", [{1.0, 2.0}], TypeError, "^AVAIL_TORQUE must be a sequence of numb"),
    ([SINGLE], "LINK_MASS_1", [Uniform(1.0, 2.0)], TypeError, "^LINK_MASS_1 must be a number, got"),
    ([SINGLE, MANY], "book_or_nips", ["b"], ValueError, "^book_or_nips must be 'book' .*, got 'b'"),
    ([SINGLE, MANY], "book_or_nips", [None], TypeError, "^book_or_nips must be 'book' or 'nips', "),
    ([MANY, OWN, DRAWN], "LINK_MASS_1", [[1, 2, None]],
     TypeError, r"^LINK_MASS_1\[2\] must be a number, got None"),
    ([MANY, OWN, DRAWN], "LINK_MASS_1", [[1, 2]],
     ValueError, "^LINK_MASS_1 must be one value, one for each of 3 environments, .*, got 2 values"),
    ([MANY, OWN], "LINK_MASS_1", [[1.0, 1e-300, 1.0]],
     ValueError, rf"^LINK_MASS_1\[1\] {FLOAT32} 1e-300"),
    ([MANY, OWN], "LINK_MASS_1", [Uniform(0.4, 0.3)], ValueError, "^LINK_MASS_1 must be .* got 0.4$"),
    ([MANY, OWN], "gravity", [Normal(9.0, 1e300, 8.0, 10.0)],
     ValueError, f"^gravity {FLOAT32} 1e300"),
    ([MANY, OWN, DRAWN], "AVAIL_TORQUE", [[-1, 1]],
     ValueError, r"^AVAIL_TORQUE must be 3 numbers, such as \[-2, 0, 2\], got 2"),
    ([MANY, OWN, DRAWN], "AVAIL_TORQUE", [[[1, 2, 3], [1, 2], [1, 2, 3]]],
     ValueError, r"^AVAIL_TORQUE\[1\] must be 3 numbers, such as"),
    ([MANY, OWN, DRAWN], "AVAIL_TORQUE", [Uniform(0, 1)],
     TypeError, "^AVAIL_TORQUE must be a sequence of 3 numbers, got 0"),
    ([MANY, OWN], "AVAIL_TORQUE", [Uniform((-1.0, 0.0, 1.0), (-1.0, 1e300, 1.0))],
     ValueError, rf"^AVAIL_TORQUE\[1\] {FLOAT32} 1e300"),
    ([MANY, OWN, DRAWN], "book_or_nips", [["book", "nips", "b"]],
     ValueError, r"^book_or_nips\[2\] must be 'book' or 'nips', got 'b'"),
    ([MANY, OWN, DRAWN], "book_or_nips", [Uniform(0, 1)],
     TypeError, "^book_or_nips must be 'book' or 'nips', got 0"),
    ([MANY, OWN, DRAWN], "LINK_COM_POS_2", [Uniform(0, 1)],
     ValueError, "^LINK_MOI_2 must be above 0 if the centre"),
    ([MANY, DRAWN], "LINK_MOI_1", [None], TypeError, "^LINK_MOI_1 must be a number, got None"),
    ([MANY, DRAWN], "LINK_MOI", [Uniform(1.0, 2.0)],
     TypeError, "^LINK_MOI must be a number; a reset can draw .* LINK_MOI_2, got Uniform"),
    ([MANY, TORQUES, SWINGUPS], "length", [1.0], AttributeError, "no attribute 'length'; .*, dt"),
    ([MANY, TORQUES, SWINGUPS], "elapsed_steps", [1.0], AttributeError, "elapsed_steps"),
    ([SINGLE], restore, [SNAPSHOT[:-1]], ValueError, "^the snapshot is damaged: "),
    ([SINGLE], restore, [b"\0" + SNAPSHOT[1:]], ValueError, "^the snapshot is of another version"),
    ([SINGLE], restore, [SNAPSHOT.replace(FOUR, b"\0")], ValueError, "^AVAIL_TORQUE must be one"),
    ([SINGLE], restore, [SNAPSHOT.replace(FOUR + NOISE, FOUR + FOUR[1:9])],
     ValueError, "^torque_noise_max must"),
]  # fmt: skip


@pytest.mark.parametrize(("envs", "call", "values", "error", "message"), CASES)
def test_a_rejected_call_changes_nothing(envs, call, values, error, message):
    """A call is a function, or the name of what is set."""
    for env in envs:
        for value in values:
            with rejects(env, error, message):
                call(env, value) if callable(call) else setattr(env, call, value)


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
