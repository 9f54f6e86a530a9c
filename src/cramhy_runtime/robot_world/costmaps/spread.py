"""Means and covariances of places: the centre of a set of poses, and how far they lie apart."""

from __future__ import annotations

from typing import Any

from .arrays import np


def mean(places: Any) -> Any:
    """The mean of ``places``, an array of rows, one for each place."""
    return np.asarray(places, float).mean(axis=0)


def covariance(places: Any, middle: Any = None) -> Any:
    """The matrix of covariances of ``places`` (rows) around ``middle``, by default their mean; divided by their number."""
    places = np.asarray(places, float)
    apart = places - (places.mean(axis=0) if middle is None else np.asarray(middle, float)[: places.shape[1]])
    return apart.T @ apart / len(places)


def wide_covariance(places: Any, minimal_variance: float = 0.1) -> Any:
    """The 2 by 2 matrix of covariances of x and y, whose variances are at least ``minimal_variance``: that of one place is no point."""
    matrix = covariance(np.asarray(places, float)[:, :2])
    matrix[[0, 1], [0, 1]] = np.maximum(matrix.diagonal(), float(minimal_variance))
    return matrix
