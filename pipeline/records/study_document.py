"""Form of ``study.json``."""

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import Count, Least0Count, Names, Sha256, Versions, form


@form()
class MessageCount(TypedDict):
    """A reason, and how many designs it refuses."""

    message: str
    """Reason, in one line."""
    count: Count
    """Number of designs."""


@form()
class DesignCounts(TypedDict):
    """Numbers of the unique designs."""

    depth: dict[str, Count]
    """By depth of the solution."""
    screen: dict[str, Count]
    """By result of the screen, or why there is none."""
    verdict: dict[str, Count]
    """By verdict, of the certified designs."""
    messages: list[MessageCount]
    """Reasons why designs have no result, the most frequent first."""


@form()
class StudyDocument(DesignCounts):
    """Summary of a finished study."""

    name: str
    """Name of the study."""
    title: str
    """Title of the study."""
    designs: Least0Count
    """Number of designs in the dataset."""
    planned: Least0Count
    """Number of designs without a stop."""
    unique: Least0Count
    """Number of unique designs that were solved."""
    stopped: str | None
    """Rule that stopped the study; null where none did."""
    kept: Names
    """Ids of the designs whose run folders are kept."""
    dataset_sha256: Sha256
    """Hash of the dataset."""
    templates: dict[str, Sha256]
    """Hash of each base case with its included files, by name."""
    versions: Versions
    """Versions of camwright, its source text, Python and the libraries."""
