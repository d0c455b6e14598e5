"""Many runs at once: what the studies in the directories here share."""
import argparse
import concurrent.futures
import csv
import json
import os
import subprocess
import sys


def arguments_of(documentation):
    """Program, directory (made) and jobs of a study from its command line."""
    parser = argparse.ArgumentParser(description=documentation.split("\n")[0])
    parser.add_argument("antiform", help="the program")
    parser.add_argument("directory", help="for the runs and the picture")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    os.makedirs(arguments.directory, exist_ok=True)
    return arguments


def run(antiform, directory, deck, entries, may_give_way=False):
    """Make the run unless it is there; its summary, or None where it failed. One whose
    section may give way (exit status 2) has its results up to there."""
    summary = os.path.join(directory, "summary.json")
    if not os.path.exists(summary):
        command = [antiform, "run", deck, "-o", directory]
        for name, value in entries.items():
            command += ["--set", f"{name}={value}"]
        done = subprocess.run(command, env={**os.environ, "OMP_NUM_THREADS": "1"},
                              capture_output=True, text=True)
        if done.returncode not in ((0, 2) if may_give_way else (0,)):
            print(f"{directory}: {done.stdout[-400:]}{done.stderr[-400:]}",
                  file=sys.stderr)
            return None
    with open(summary) as file:
        return json.load(file)


def run_all(job, keys, n_jobs):
    """job(*key) of every key, n_jobs at once: a dictionary by key."""
    results = {}
    with concurrent.futures.ThreadPoolExecutor(n_jobs) as pool:
        futures = {pool.submit(job, *key): key for key in keys}
        for n, future in enumerate(concurrent.futures.as_completed(futures), 1):
            results[futures[future]] = future.result()
            if n % 25 == 0 or n == len(keys):
                print(f"{n} of {len(keys)} runs", flush=True)
    return results


def rows_of(job, keys, n_jobs):
    """The lines job(*key) of all keys, in their order; ends the program if one failed."""
    found = run_all(job, keys, n_jobs)
    rows = [found[key] for key in keys if found[key] is not None]
    if len(rows) < len(keys):
        sys.exit(f"{len(keys) - len(rows)} of {len(keys)} runs failed, see above")
    return rows


def save(figure, directory, name):
    for suffix in ("svg", "png"):
        figure.savefig(os.path.join(directory, f"{name}.{suffix}"), dpi=130,
                       metadata={"Date": None} if suffix == "svg" else None)


def write_table(rows, path):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
