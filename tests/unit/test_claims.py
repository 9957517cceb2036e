"""Words of a claim, such as smallest or best, are printed only where a search shows it.

Each claim is over a stated set, and names the test that proves it. A new one is added here with
its proof, or says what was shown: found, the smallest of those tried.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PRINTING = ("pipeline/commands", "pipeline/studies", "pipeline/search",
            "pipeline/smoothing", "pipeline/iteration.py", "reports",
            "validation/pages/mechanism_figures.py")  # fmt: skip
CLAIM = re.compile(
    r"\b(smallest|best|optimal|optimum|pareto|none passes|none does|no other|no design|no cam|"
    r"no part|no smoother|fewest|least (?:ripple|crown|energy|contact|pressure|prime|size|change))"
    r"\b",
    re.IGNORECASE,
)

CLAIMS = {
    # over the designs that were solved, and single exchanges of parts
    "smallest of those solved that do": "test_a_pump_passes_by_finite_elements",
    "smallest of the solved cases": "test_a_pump_passes_by_finite_elements",
    "smallest of the designs that were solved": "test_a_pump_passes_by_finite_elements",
    "no part can be exchanged": "test_parts_are_exchanged_until_none_passes",
    # closed forms of the size, against published values and against neighbours
    "smallest base radius": "test_published_size_of_a_roller_cam",
    "least pressure angle of rise against return": "test_best_offset_keeps_the_curvature",
    "least contact pressure within curvature": "test_a_roller_has_the_least_contact_pressure",
    "least energy at full lift": "test_smallest_spring_of_a_harmonic_cam",
    "least energy of the spring at full lift": "test_smallest_spring_of_a_harmonic_cam",
    # over the designs of a front or a study
    "Pareto front of torque ripple": "test_points_are_a_front_of_feasible_cases",
    "Pareto front": "test_the_front_against_every_pair",
    'failed, pareto, or best:N such as "best:10"': "test_the_answers_are_those_of_the_rows",
    'deeper.take = "best"': "test_the_answers_are_those_of_the_rows",
    "no design passes by its": "test_the_answers_are_those_of_the_rows",
    "No design has a result": "test_the_answers_are_those_of_the_rows",
    # over the smoothers and trials listed
    "no smoother reduces the ripple": "test_without_a_cam_or_a_reduction_nothing_is_recommended",
    "fewest failing": "test_rank_is_by_failing_checks_then_ripple_and_missing_data_are_no_failure",
    "none passes": "test_lines_state_the_recommendation_first_and_the_missing_data_once",
    "no smoother gives a cam": "test_without_a_cam_or_a_reduction_nothing_is_recommended",
    "above the best cam": "test_bands_lie_above_the_best_mechanism",
    "no cam: ": "test_without_a_cam_or_a_reduction_nothing_is_recommended",
    "no smoother that keeps": "test_never_more_trials_than_allowed_and_the_last_is_the_best",
    "best tried": "test_never_more_trials_than_allowed_and_the_last_is_the_best",
    "is the best; it is repeated": "test_going_back_repeats_the_best_and_then_ends",
    "the best of {} trials": "test_never_more_trials_than_allowed_and_the_last_is_the_best",
    # of the synthesis, against a nonlinear program; of its starts, as many as stated
    "least ripple within all limits": "test_variant_ends_at_the_optimum",
    "least ripple": "test_variant_ends_at_the_optimum",
    "the best of them may be no global optimum": "test_starts_that_do_not_agree_say_so",
    "lead to no cam within all limits": "test_no_start_within_the_limits",
}
"""Words of each claim, and the function that tests it."""
NO_CLAIMS = ("INCOMPLETE at best", "no cam force", "no design within", "no smoother to widen")


def printed(path: Path) -> Iterator[str]:
    """Texts of a module that are not its docstrings; those of a command are printed as its help."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    inner, left_out = set[ast.AST](), set[ast.AST]()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and path.name == f"{node.name}_command.py":
            yield ast.get_docstring(node) or ""
        if isinstance(node, ast.Expr):
            left_out.add(node.value)
        if isinstance(node, ast.JoinedStr):
            inner.update(each for each in ast.walk(node) if each is not node)
    for node in ast.walk(tree):
        if node in inner or node in left_out:
            continue
        if isinstance(node, ast.JoinedStr):
            parts = (each.value if isinstance(each, ast.Constant) else "{}" for each in node.values)
            yield "".join(map(str, parts))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def claims() -> Iterator[tuple[str, str]]:
    """Module and text of each claim; identifiers of one word are none."""
    for place in PRINTING:
        path = ROOT / place
        for module in [path] if path.is_file() else sorted(path.rglob("*.py")):
            name = module.relative_to(ROOT).as_posix()
            for text in map(" ".join, map(str.split, printed(module))):
                if " " in text and CLAIM.search(text):
                    yield name, text


@pytest.fixture(scope="module")
def made() -> list[tuple[str, str]]:
    return list(claims())


def test_every_claim_is_listed_with_its_proof(made: list[tuple[str, str]]) -> None:
    unproven = []
    for name, text in made:
        left = text
        for words in sorted((*CLAIMS, *NO_CLAIMS), key=len, reverse=True):
            left = left.replace(words, "")
        if word := CLAIM.search(left):
            unproven.append(f"{name}: {word[0]} in: {text[:300]}")
    assert not unproven, "\n".join(unproven)


def test_no_listed_claim_is_gone(made: list[tuple[str, str]]) -> None:
    texts = "\n".join(text for _, text in made)
    gone = [words for words in (*CLAIMS, *NO_CLAIMS) if words not in texts]
    assert gone == []


def test_every_proof_is_a_test() -> None:
    defined = {
        match
        for path in (ROOT / "tests").rglob("test_*.py")
        for match in re.findall(r"^def (test_\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert set(CLAIMS.values()) <= defined
