"""Cases in their quick form, side by side: ``python tests/quick_cases.py FOLDER CASE ...``."""

import json
import sys
from pathlib import Path

from fe_drivetrain.suite import all_cases, run_cases

#: Why cases have no results, by name, in the folder.
PROBLEMS = "problems.json"

if __name__ == "__main__":
    folder, wanted = Path(sys.argv[1]), set(sys.argv[2:])
    # from the last: the first compile what the first tests compile at the same time
    cases = [case for name, case in reversed(all_cases().items()) if name in wanted]
    problems = run_cases(cases, folder, quick=True)
    (folder / PROBLEMS).write_text(json.dumps(problems))
