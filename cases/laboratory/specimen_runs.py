"""What the studies of specimens share."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import run, run_all, write_table  # noqa: E402, F401


def add_arguments(parser):
    parser.add_argument("antiform", help="the program")
    parser.add_argument("directory", help="for the runs and the report")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
