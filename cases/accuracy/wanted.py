#!/usr/bin/python3
"""The table 'error wanted, settings, seconds' of docs/accuracy.md.

    /usr/bin/python3 cases/accuracy/wanted.py ANTIFORM

What 'antiform check' chooses by the record for eight scenes, with the core seconds that it
predicts; no run is made.
"""
import argparse
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
BENT, BURIED = os.path.join(HERE, "wanted.prm"), os.path.join(HERE, "wanted-buried.prm")
SCENES = (("bent layer, event driver", BENT, []),
          ("bent layer, walls at a constant rate", BENT, ["Walls/Loading=constant rate"]),
          ("bent layer of L/h = 33.7, event driver", BENT, ["Layer/Length ratio=33.7"]),
          ("bent layer of L/h = 33.7, walls at a constant rate", BENT,
           ["Layer/Length ratio=33.7", "Walls/Loading=constant rate"]),
          ("specimen, event driver", BENT, ["Layer/Shape=straight", "Layer/Length ratio=2"]),
          ("specimen, walls at a constant rate", BENT,
           ["Layer/Shape=straight", "Layer/Length ratio=2", "Walls/Loading=constant rate"]),
          ("buried layer of grains, critical stress", BURIED, []),
          ("buried layer of finite elements, critical stress", BURIED,
           ["Layer/Representation=continuum", "Matrix/Element degree=2"]))
WANTED = (20, 10, 5, 2, 1)


def checked(antiform, deck, entries):
    command = [antiform, "check", deck, "--json"]
    for entry in entries:
        command += ["--set", entry]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 0:
        return json.loads(done.stdout)
    if "smallest possible is" not in done.stderr:
        sys.exit(done.stderr)
    return float(done.stderr.split("smallest possible is ")[1].split(" %")[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("antiform", help="the program")
    antiform = parser.parse_args().antiform
    print("| scene | error wanted | settings | errors together | core seconds, predicted |\n"
          "| --- | --- | --- | --- | --- |")
    for name, deck, entries in SCENES:
        for percent in WANTED:
            found = checked(antiform, deck, entries + [f"Accuracy={percent} %"])
            if isinstance(found, float):
                print(f"| {name} | {percent} % | not in the record: {found:g} % at the "
                      "least | | |")
                break
            settings = ", ".join(f"{s['entry'].split('/')[1].lower()} {s['value']}"
                                 for s in found["accuracy"]["settings"] if s["chosen"])
            print(f"| {name} | {percent} % | {settings} | "
                  f"{found['accuracy']['sum_percent']:.2g} % | "
                  f"{found['prediction']['core_seconds']:.3g} |")


if __name__ == "__main__":
    main()
