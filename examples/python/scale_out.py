"""Plays episodes on all workers of a Ray cluster and writes them into one Parquet file, with a row for each episode.

    python scale_out.py                            starts a cluster on this machine, which listens on loopback only
    python scale_out.py --workers 2 --kill 3       kills the worker of shard 3 half-way; the file is the same
    python scale_out.py --address 10.0.0.1:6379    uses a cluster with acrobot-rs and pyarrow on each node

The work is divided into shards. A shard depends only on its number, the seed and the settings, so the file does not depend on
the number of workers. Shard k has the k-th child of the seed. The first child of that seeds the environments, and the second
one seeds the random policy. If a worker dies, its shard is played again.

Every environment plays the same number of episodes. A limit on steps would count too many short episodes.
"""

import argparse
import contextlib
import importlib.metadata
import json
import os
import secrets
import signal
import socket
import sys
import tempfile
import time
from collections import Counter, deque
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from acrobot_rs import AcrobotVectorEnv
from tqdm import tqdm

TRIES = 3
POLICIES = {
    "random": lambda observations, rng: rng.integers(3, size=len(observations)),
    # Torque against the first link's velocity.
    "bang-bang": lambda observations, rng: np.where(observations[:, 4] > 0, 0, 2),
}


class ShardError(Exception):
    """A shard failed, or was lost too often."""


class Played(NamedTuple):
    worker: str
    seconds: float
    table: pa.Table


def streams(seed, shard):
    """A shard's two streams: the seed of its environments, 256 bits, and the generator of its policy."""
    environments, draws = np.random.SeedSequence(seed, spawn_key=(shard,)).spawn(2)
    words = environments.generate_state(8).astype("<u4")
    return int.from_bytes(words.tobytes(), "little"), np.random.default_rng(draws)


def play(seed, shard, environments, episodes, policy):
    """Plays a shard. Returns a row for each episode, by environment and episode: length, return, terminated, truncated."""
    reset_seed, rng = streams(seed, shard)
    envs = AcrobotVectorEnv(environments, copy=False)
    observations, _ = envs.reset(seed=reset_seed)
    done, steps, returns = np.zeros((3, environments), np.int32)
    columns = {
        name: np.empty((environments, episodes), dtype)
        for name, dtype in [("length", np.int32), ("return", np.int32), ("terminated", np.bool_), ("truncated", np.bool_)]
    }
    while done.min() < episodes:
        observations, rewards, terminated, truncated, _ = envs.step(POLICIES[policy](observations, rng))
        steps += 1
        returns += rewards.astype(np.int32)
        ended = np.flatnonzero(terminated | truncated)
        if len(ended):
            counted = ended[done[ended] < episodes]
            for column, values in zip(columns.values(), (steps, returns, terminated, truncated), strict=True):
                column[counted, done[counted]] = values[counted]
            done[ended] += 1
            steps[ended] = -1  # the next step only resets
            returns[ended] = 0
    environment, episode = np.indices((environments, episodes), np.int32)
    keys = {"shard": np.full_like(episode, shard), "environment": environment, "episode": episode}
    return pa.table({name: column.ravel() for name, column in (keys | columns).items()})


def work(what, kill, shard, attempt):
    """Plays a shard on a worker. If this shard is to be killed, plays half of it and kills the worker."""
    import ray

    if shard == kill and attempt == 1:
        play(shard=shard, **what | {"episodes": (what["episodes"] + 1) // 2})
        os.kill(os.getpid(), signal.SIGKILL)
    start = time.perf_counter()
    table = play(shard=shard, **what)
    seconds = time.perf_counter() - start
    return Played(f"{ray.util.get_node_ip_address()} {os.getpid()}", seconds, table)


@contextlib.contextmanager
def cluster(address, cpus):
    """Connects to the cluster at an address, or starts one that listens on loopback only. Yields its number of CPUs.

    Ray is imported here, because it reads its environment variables on import.
    """
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    if address is None:
        # 0 keeps the cluster on loopback, as is the default on Windows and macOS. An address passed to `init` does not.
        os.environ.setdefault("RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER", "0")
        # Without this variable Ray would write a token into the home folder.
        os.environ.setdefault("RAY_AUTH_MODE", "token")
        os.environ.setdefault("RAY_AUTH_TOKEN", secrets.token_hex(32))
    import ray

    with tempfile.TemporaryDirectory(prefix="scale_out-", dir="/tmp", ignore_cleanup_errors=True) as folder:
        local = {"num_cpus": cpus, "include_dashboard": False, "_temp_dir": folder} if address is None else {}
        try:
            ray.init(address=address or "local", log_to_driver=False, logging_level="error", **local)
            yield int(ray.cluster_resources().get("CPU", 0))
        finally:
            ray.shutdown()


def play_all(work, shards, workers):
    """Yields each shard with the result of `work(shard, attempt)` on a worker, in the order of completion.

    Ray's own retries are off. If a worker dies, its shard is played again here, at most `TRIES` times in total. So a shard that
    kills every worker ends the run. An exception in a shard would occur again, so it ends the run immediately.
    """
    import ray
    from ray.exceptions import RayError, RayTaskError

    remote = ray.remote(num_cpus=1, max_retries=0)(work)
    waiting, running = deque((shard, 1) for shard in range(shards)), {}
    while waiting or running:
        while waiting and len(running) < workers:
            shard, attempt = waiting.popleft()
            running[remote.remote(shard, attempt)] = shard, attempt
        [ref], _ = ray.wait(list(running))
        shard, attempt = running.pop(ref)
        try:
            played = ray.get(ref)
        except RayTaskError as error:
            raise ShardError(f"shard {shard} fails: {error.cause!r}") from error
        except RayError as error:
            if attempt == TRIES:
                raise ShardError(f"shard {shard} was lost {TRIES} times: {error}") from error
            tqdm.write(f"shard {shard} is lost ({type(error).__name__}) and played again", file=sys.stderr)
            waiting.append((shard, attempt + 1))
        else:
            yield shard, played


def gather(what, shards, workers, kill=None):
    """Plays all shards. Returns their rows as one table, in order, and what `work` returned for each shard."""
    results = play_all(lambda shard, attempt: work(what, kill, shard, attempt), shards, workers)
    played = dict(tqdm(results, total=shards, unit="shard"))
    table = pa.concat_tables(played[shard].table for shard in range(shards))
    settings = what | {"shards": shards, "acrobot-rs": importlib.metadata.version("acrobot-rs")}
    return table.replace_schema_metadata({"scale_out": json.dumps(settings)}), played.values()


def write(table, path):
    """Writes the whole file, or leaves the old one."""
    part = path.with_name(path.name + ".part")
    pq.write_table(table, part)
    part.replace(path)


def report(played, seconds):
    """Prints steps per second: for each worker its playing time counts, and in total the whole time, with Ray's overhead."""
    shards, steps, busy = Counter(), Counter(), Counter()
    for worker, took, table in played:
        shards[worker] += 1
        steps[worker] += sum(table["length"].to_numpy())
        busy[worker] += took
    print(f"{'worker':28}{'shards':>8}{'steps':>16}{'steps/s':>14}")
    for worker in sorted(shards):
        print(f"{worker:28}{shards[worker]:8}{steps[worker]:16,}{steps[worker] / busy[worker]:14,.0f}")
    print(f"{'total':28}{shards.total():8}{steps.total():16,}{steps.total() / seconds:14,.0f}")


def whole(low, high=None):
    """A parser for argparse: integers within bounds."""

    def parse(text):
        rule = f"an integer of at least {low}" if high is None else f"an integer from {low} to {high}"
        if not (text.isascii() and text.isdigit() and low <= int(text) and (high is None or int(text) <= high)):
            raise argparse.ArgumentTypeError(f"must be {rule}, got {text!r}")
        return int(text)

    return parse


def listening(text):
    """A parser for argparse: an address where something listens. Without one, Ray would retry forever."""
    host, _, port = text.rpartition(":")
    try:
        socket.create_connection((host, int(port)), timeout=10).close()
    except (OSError, OverflowError, ValueError) as error:
        raise argparse.ArgumentTypeError(f"must be host:port of a cluster's head, got {text!r}: {error}") from error
    return text


def parse(arguments):
    count = whole(1, 2**31 - 1)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shards", type=count, default=8, help="default 8")
    parser.add_argument("--environments", type=count, default=1024, help="per shard; default 1024")
    parser.add_argument("--episodes", type=count, default=100, help="per environment; default 100")
    parser.add_argument("--policy", choices=POLICIES, default="bang-bang", help="default bang-bang")
    parser.add_argument("--seed", type=whole(0), default=0, help="an integer of at least 0, of any size; default 0")
    parser.add_argument("--workers", type=count, help="default: one for each CPU of the cluster")
    parser.add_argument("--address", type=listening, help="host:port of the head of an existing cluster")
    parser.add_argument("--kill", type=whole(0), metavar="SHARD", help="kill the worker of this shard half-way, as a test")
    parser.add_argument("--output", type=Path, default=Path("episodes.parquet"), help="default episodes.parquet")
    options = parser.parse_args(arguments)
    if options.workers and options.workers > options.shards:
        parser.error(f"--workers must be 1 to {options.shards}, the number of shards, got {options.workers}")
    if options.kill is not None and options.kill >= options.shards:
        parser.error(f"--kill must be 0 to {options.shards - 1}, a shard, got {options.kill}")
    if options.output.is_dir() or not options.output.parent.is_dir():
        parser.error(f"--output must be a file in a folder that exists, got {options.output}")
    return options


def main(arguments=None):
    options = parse(arguments)
    what = {name: getattr(options, name) for name in ("seed", "environments", "episodes", "policy")}
    try:
        with cluster(options.address, options.workers) as cpus:
            # Replaces Ray's handler, which would leave the cluster running.
            signal.signal(signal.SIGTERM, lambda *_: sys.exit("terminated"))
            workers = options.workers or min(cpus, options.shards)
            if not 1 <= workers <= cpus:
                sys.exit(f"--workers must be 1 to {cpus}, the CPUs of the cluster, got {workers}")
            start = time.perf_counter()
            table, played = gather(what, options.shards, workers, options.kill)
            seconds = time.perf_counter() - start
    except (ConnectionError, ShardError) as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit(130)
    write(table, options.output)
    report(played, seconds)


if __name__ == "__main__":
    main()
