# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Searches parameters over a set of recordings with Optuna, and goes on where it was killed.

The search is over rounds of some trials each, told to Optuna in the order in which they were asked for, and its random
numbers follow from how many are done: a search that was killed ends as one that was not.
"""

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from oort._core import Parameters
from oort.errors import InputError, OortError, ParameterError
from oort.export.files import write_atomically
from oort.offline.scoring import Score, Trial, score
from oort.offline.search_space import Axis, Value
from oort.offline.workers import fingerprint, in_pool
from oort.parameters.reader import set_parameter
from oort.parameters.writer import to_json

if TYPE_CHECKING:
    import optuna

_FLOOR = 0.002
"""[m, or of agreement]; a recording that is mapped as well as this before and after counts as unchanged"""
_FAILED = 10.0
"""A recording that cannot be mapped counts as one whose error is so many times that of the start."""
_RANDOM_TRIALS = 10
"""before Optuna's sampler goes by what it has seen; its own default"""


@dataclass(frozen=True)
class Task:
    """What is searched."""

    recordings: tuple[str, ...]
    start: Parameters
    axes: tuple[Axis, ...]
    seed: int = 0
    at_once: int = 1
    """trials in a round; each takes as many workers as there are recordings"""


@dataclass(frozen=True)
class Tried:
    """One set of values and what came of it."""

    number: int
    values: Mapping[str, Value]
    error: float
    """over all recordings, as a multiple of that of the start"""


class Search:
    """A search whose state lies in a folder."""

    def __init__(self, task: Task, folder: Path, pool: Executor) -> None:
        """Begins a search, or goes on with the one in the folder. Raises InputError if that is another one."""
        self._task, self._folder, self._pool = task, folder, pool
        (folder / "scores").mkdir(parents=True, exist_ok=True)
        self._study = _open_study(folder)
        told = _told(task)
        if self._study.user_attrs.get("task", told) != told:
            raise InputError(
                f"{folder} holds a search with other recordings, keys, bounds, parameters or seed; choose another --out"
            )
        self._study.set_user_attr("task", told)
        self.start_scores = self.scores(task.recordings, task.start)

    def run(self, trials: int) -> Iterator[Tried]:
        """All trials up to a number, those of before first."""
        for frozen in self._study.trials:
            if not frozen.state.is_finished():  # it was running when the search was killed
                self._study.tell(frozen.number, state=_states().FAIL)
        done = [Tried(i, frozen.params, frozen.value) for i, frozen in enumerate(self._complete())]
        yield from done
        while len(done) < trials:
            for tried in self._round(len(done), min(self._task.at_once, trials - len(done))):
                done.append(tried)
                yield tried

    def with_values(self, values: Mapping[str, Value]) -> Parameters:
        """The parameters of the start but for some values. Raises ParameterError if they do not go together."""
        parameters = self._task.start.copy()
        for path, value in values.items():
            set_parameter(parameters, path, value)
        parameters.check()
        return parameters

    def scores(self, recordings: Sequence[str], parameters: Parameters) -> dict[str, Score]:
        """What each recording makes of some parameters, in the order of the recordings."""
        found = self._score_all([(recording, parameters) for recording in recordings])[_text(parameters)]
        return {recording: found[recording] for recording in recordings}

    def relative_error(self, scores: Mapping[str, Score]) -> float:
        """The geometric mean over the recordings of the error as a multiple of that of the start."""
        ratios = [_ratio(scores[name], self.start_scores[name]) for name in self._task.recordings]
        return math.exp(sum(map(math.log, ratios)) / len(ratios))

    def _complete(self) -> list[Any]:
        trials: list[Any] = self._study.get_trials(deepcopy=False, states=(_states().COMPLETE,))
        return trials

    def _round(self, done: int, count: int) -> list[Tried]:
        import optuna

        self._study.sampler = optuna.samplers.TPESampler(
            seed=self._task.seed * 100_003 + done, n_startup_trials=_RANDOM_TRIALS, constant_liar=True
        )
        distributions = {axis.path: _distribution(axis) for axis in self._task.axes}
        asked = [self._study.ask(distributions) for _ in range(count)]
        sets: dict[int, Parameters] = {}
        for trial in asked:
            try:
                sets[trial.number] = self.with_values(trial.params)
            except ParameterError:
                continue  # values that do not go together, each of which alone may be
        found = self._score_all([(name, p) for p in sets.values() for name in self._task.recordings])
        tried = []
        for number, trial in enumerate(asked, start=done):
            known = sets.get(trial.number)
            error = _FAILED if known is None else self.relative_error(found[_text(known)])
            self._study.tell(trial, error)
            tried.append(Tried(number, trial.params, error))
        return tried

    def _score_all(self, wanted: Sequence[tuple[str, Parameters]]) -> dict[str, dict[str, Score]]:
        """Scores by the text of the parameters and the recording; each is written down as it comes."""
        found: dict[str, dict[str, Score]] = {}
        waiting: list[Trial] = []
        for recording, parameters in wanted:
            trial = Trial(recording, _text(parameters))
            kept = self._kept(trial)
            if kept is None:
                waiting.append(trial)
            else:
                found.setdefault(trial.parameters, {})[recording] = kept
        for trial, result in in_pool(self._pool, score, waiting):
            told = Score("failed", 0.0, str(result)) if isinstance(result, OortError) else result
            write_atomically(self._place(trial), json.dumps(asdict(told)).encode())
            found.setdefault(trial.parameters, {})[trial.recording] = told
        return found

    def _place(self, trial: Trial) -> Path:
        key = hashlib.sha256(f"{fingerprint(trial.recording)} {trial.parameters}".encode()).hexdigest()
        return self._folder / "scores" / f"{key}.json"

    def _kept(self, trial: Trial) -> Score | None:
        try:
            kept = Score(**json.loads(self._place(trial).read_text()))
            return kept if math.isfinite(kept.error) else None
        except (OSError, ValueError, TypeError, OverflowError, RecursionError):
            return None


def _ratio(ours: Score, start: Score) -> float:
    if ours.kind == "failed":
        return 1.0 if start.kind == "failed" else _FAILED
    reference = 1.0 if start.kind == "failed" else start.error
    return min(_FAILED, (ours.error + _FLOOR) / (reference + _FLOOR))


def _text(parameters: Parameters) -> str:
    return to_json(parameters.to_dict())


def _told(task: Task) -> str:
    parts = [*map(fingerprint, task.recordings), _text(task.start), repr(task.axes), str(task.seed), str(task.at_once)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def _open_study(folder: Path) -> "optuna.Study":
    try:
        import optuna
        from optuna.storages.journal import JournalFileBackend
    except ImportError as error:
        raise InputError('oort tune needs Optuna: pip install "oort[tune]"') from error
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    log = folder / "study.log"
    try:
        storage = optuna.storages.JournalStorage(JournalFileBackend(str(log)))
        study = optuna.create_study(storage=storage, study_name="oort", load_if_exists=True)
        study.get_trials(deepcopy=False)  # reads what was tried
    except OSError:
        raise
    except Exception as error:  # damage shows in many ways
        raise InputError(
            f"{log} is no search that can be gone on with ({type(error).__name__}: {error}); choose another --out"
        ) from error
    return study


def _states() -> Any:
    import optuna

    return optuna.trial.TrialState


def _distribution(axis: Axis) -> Any:
    from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution

    if axis.choices:
        return CategoricalDistribution(axis.choices)
    if axis.whole:
        low, high = math.ceil(axis.low), math.floor(axis.high)
        return IntDistribution(low, high, log=axis.logarithmic and low > 0)
    return FloatDistribution(axis.low, axis.high, log=axis.logarithmic)
