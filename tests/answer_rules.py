"""What an answer has to be, so that its reader sees at once what was found."""

import sys
from collections.abc import Collection

from fe_drivetrain.report.answer import MAX_WORDS, Answer, words
from fe_drivetrain.report.results import Chart, Image, Results, Solid, Verdict, read_results


def broken_rules(results: Results) -> list[str]:
    """What is wrong with the answer of results, in words; empty where nothing is."""
    if results.answer is None:
        return ["there is no answer"]
    pictures = [
        item.caption
        for section in results.sections
        for item in section.items
        if isinstance(item, Chart | Image | Solid)
    ]
    return broken_by(results.answer, pictures, results.verdicts)


def broken_by(answer: Answer, pictures: Collection[str], checks: Collection[Verdict]) -> list[str]:
    """What is wrong with an answer that stands beside pictures of these captions, and checks."""
    of_itself = [
        check.quantity
        for check in checks
        if check.measure == "identity" or check.basis == "self-consistency"
    ]
    rules = {
        f"the verdict has {words(answer.verdict)} words": words(answer.verdict) <= MAX_WORDS,
        "the verdict does not end with a point": answer.verdict.endswith("."),
        "the verdict has no number": any(letter.isdigit() for letter in answer.verdict),
        "the question does not end with a question mark": answer.question.endswith("?"),
        f"there are {len(answer.figures)} key figures": 3 <= len(answer.figures) <= 6,
        f"no picture is called {answer.hero!r}": answer.hero in pictures,
    }
    broken = [fault for fault, is_kept in rules.items() if not is_kept]
    if answer.claim == "does not hold" and "not" not in answer.verdict.lower():
        broken.append("the verdict does not say that the statement of the source does not hold")
    return broken + [
        f"a check of the program on itself is a key figure: {figure.name}"
        for figure in answer.figures
        if figure.quantity in of_itself
    ]


if __name__ == "__main__":
    for path in sys.argv[1:]:
        found = read_results(path)
        for fault in broken_rules(found):
            print(f"{found.case}: {fault}")
