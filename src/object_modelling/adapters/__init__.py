"""Detections of the recogniser in messages of other packages, one module for each; those packages need not be there."""
