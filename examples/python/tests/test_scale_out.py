"""The table of scale_out.py depends neither on the number of workers nor on their deaths."""

import os
import secrets
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scale_out
from acrobot_rs import AcrobotVectorEnv

SCRIPT = Path(scale_out.__file__)
SHARDS = 8
WHAT = {"seed": 2**70 + 1, "environments": 20, "episodes": 4, "policy": "bang-bang"}


HEAD = """
import scale_out
with scale_out.cluster(None, 4):
    import ray
    print(ray.get_runtime_context().gcs_address, flush=True)
    input()
"""


@pytest.fixture(scope="module")
def address():
    """The address of a cluster with four CPUs, to which this process is connected.

    Another process starts it, because Ray forks, and this process must not: it has JAX's threads.
    """
    with pytest.MonkeyPatch.context() as patch:
        # Must be set before Ray is imported. Otherwise Ray replaces 127.0.0.1 by the address of another interface.
        patch.setenv("RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER", "0")
        # A token for this cluster only. Otherwise Ray would write one into the home folder.
        patch.setenv("RAY_AUTH_MODE", "token")
        patch.setenv("RAY_AUTH_TOKEN", secrets.token_hex(32))
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        with subprocess.Popen([sys.executable, "-c", HEAD], cwd=SCRIPT.parent, **pipes) as head:
            address = head.stdout.readline().strip()
            assert address.startswith("127.0.0.1:")
            with scale_out.cluster(address, None) as cpus:
                assert cpus == 4
                yield address
            head.communicate("\n", timeout=60)
            assert head.returncode == 0


@pytest.fixture(scope="module")
def expected():
    """The rows of all shards, played one after the other in this process."""
    return pa.concat_tables(scale_out.play(shard=shard, **WHAT) for shard in range(SHARDS))


def command(*arguments):
    """Runs the script in another process, with the settings above."""
    what = [f"--{name}={value}" for name, value in (WHAT | {"shards": SHARDS}).items()]
    return subprocess.run([sys.executable, SCRIPT, *what, *arguments], capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_the_number_of_workers_changes_nothing(address, expected, workers):
    table, played = scale_out.gather(WHAT, SHARDS, workers)
    assert table.equals(expected)
    assert len(played) == SHARDS


def test_a_killed_worker_changes_nothing(address, expected, capfd):
    table, played = scale_out.gather(WHAT, SHARDS, 2, kill=3)
    assert table.equals(expected)
    assert "shard 3 is lost (WorkerCrashedError) and played again" in capfd.readouterr().err


@pytest.mark.parametrize("policy", scale_out.POLICIES)
def test_rows_are_the_episodes_of_the_vector_environment(policy):
    """The expected rows come from a loop over environments."""
    shard, environments, episodes = 5, 30, 3
    table = scale_out.play(WHAT["seed"], shard, environments, episodes, policy)
    child = np.random.SeedSequence(WHAT["seed"]).spawn(shard + 1)[shard]
    seeds, draws = child.spawn(2)
    rng = np.random.default_rng(draws)
    envs = AcrobotVectorEnv(environments)
    observations, _ = envs.reset(seed=sum(int(word) << 32 * i for i, word in enumerate(seeds.generate_state(8))))
    rows = {(i, episode): [] for i in range(environments) for episode in range(episodes)}
    episode, fresh = [0] * environments, [False] * environments
    while min(episode) < episodes:
        if policy == "random":
            actions = rng.integers(3, size=environments)
        else:
            actions = [0 if velocity > 0 else 2 for velocity in observations[:, 4]]
        observations, rewards, terminated, truncated, _ = envs.step(actions)
        for i in range(environments):
            if not fresh[i] and episode[i] < episodes:
                rows[i, episode[i]].append((rewards[i], terminated[i], truncated[i]))
            fresh[i] = terminated[i] or truncated[i]
            episode[i] += fresh[i]
    assert table.to_pylist() == [
        {
            "shard": shard,
            "environment": i,
            "episode": episode,
            "length": len(steps),
            "return": sum(reward for reward, _, _ in steps),
            "terminated": steps[-1][1],
            "truncated": steps[-1][2],
        }
        for (i, episode), steps in rows.items()
    ]
    ends = table["truncated" if policy == "random" else "terminated"].to_numpy()
    assert ends.mean() > 0.9


def test_shards_and_seeds_have_different_streams():
    seeds = {scale_out.streams(seed, shard)[0] for seed in (0, 1, 2**64) for shard in range(100)}
    draws = {scale_out.streams(seed, shard)[1].integers(2**63) for seed in (0, 1, 2**64) for shard in range(100)}
    assert len(seeds) == len(draws) == 300


def test_a_shard_that_kills_every_worker_ends_the_run(address):
    def die(shard, attempt):
        if shard == 1:
            os.kill(os.getpid(), signal.SIGKILL)
        return attempt

    with pytest.raises(scale_out.ShardError, match="shard 1 was lost 3 times: The worker died"):
        list(scale_out.play_all(die, 3, 2))


def test_an_error_in_a_shard_ends_the_run_immediately(address, tmp_path):
    def fail(shard, attempt):
        with open(tmp_path / f"{shard} {attempt}", "x"):
            raise MemoryError("too many environments")

    with pytest.raises(scale_out.ShardError, match=r"shard 0 fails: MemoryError\('too many environments'\)"):
        list(scale_out.play_all(fail, 3, 1))
    assert [mark.name for mark in tmp_path.iterdir()] == ["0 1"]


def test_a_killed_worker_and_a_new_cluster_give_the_same_file(tmp_path, expected):
    """All bytes are the same, because the file contains neither times nor workers."""
    one, other = tmp_path / "killed.parquet", tmp_path / "direct.parquet"
    run = command("--workers=2", "--kill=6", f"--output={one}")
    assert run.returncode == 0, run.stderr
    assert "shard 6 is lost" in run.stderr
    assert run.stdout.splitlines()[-1].split()[:3] == ["total", "8", f"{sum(expected['length'].to_numpy()):,}"]
    table = pq.read_table(one)
    assert table.equals(expected)
    assert b'"seed": 1180591620717411303425' in table.schema.metadata[b"scale_out"]
    scale_out.write(expected.replace_schema_metadata(table.schema.metadata), other)
    assert one.read_bytes() == other.read_bytes()
    assert sorted(tmp_path.iterdir()) == sorted([one, other])


def test_an_existing_cluster_is_joined(address, tmp_path, expected):
    output = tmp_path / "episodes.parquet"
    run = command(f"--address={address}", f"--output={output}", "--workers=3")
    assert run.returncode == 0, run.stderr
    assert pq.read_table(output).equals(expected)
    run = command(f"--address={address}", f"--output={output}", "--workers=5")
    assert run.returncode == 1
    assert run.stderr == "--workers must be 1 to 4, the CPUs of the cluster, got 5\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--shards=0"], "--shards: must be an integer from 1 to 2147483647, got '0'"),
        (["--episodes=2147483648"], "--episodes: must be an integer from 1 to 2147483647, got '2147483648'"),
        (["--environments=-1"], "--environments: must be an integer from 1 to 2147483647, got '-1'"),
        (["--seed=-1"], "--seed: must be an integer of at least 0, got '-1'"),
        (["--seed=1.5"], "--seed: must be an integer of at least 0, got '1.5'"),
        (["--policy=best"], "--policy: invalid choice: 'best'"),
        (["--workers=0"], "--workers: must be an integer from 1 to 2147483647, got '0'"),
        (["--workers=9"], "--workers must be 1 to 8, the number of shards, got 9"),
        (["--kill=8"], "--kill must be 0 to 7, a shard, got 8"),
        (["--output=."], "--output must be a file in a folder that exists, got ."),
        (["--output=nowhere/a"], "--output must be a file in a folder that exists, got nowhere/a"),
        (["--address=127.0.0.1:1"], "--address: must be host:port of a cluster's head, got '127.0.0.1:1'"),
        (["--address=nonsense"], "--address: must be host:port of a cluster's head, got 'nonsense'"),
    ],
)
def test_invalid_arguments_are_rejected(arguments, message, capsys):
    with pytest.raises(SystemExit) as rejected:
        scale_out.main(arguments)
    assert rejected.value.code == 2
    assert message in capsys.readouterr().err
