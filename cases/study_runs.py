"""Many runs at once: what the studies in the directories here share."""
import concurrent.futures
import csv
import json
import os
import subprocess
import sys


def run(antiform, directory, deck, entries):
    """Make the run unless it is there; its summary, or None where it failed."""
    summary = os.path.join(directory, "summary.json")
    if not os.path.exists(summary):
        command = [antiform, "run", deck, "-o", directory]
        for name, value in entries.items():
            command += ["--set", f"{name}={value}"]
        done = subprocess.run(command, env={**os.environ, "OMP_NUM_THREADS": "1"},
                              capture_output=True, text=True)
        if done.returncode != 0:
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


def write_table(rows, path):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
