"""Python side of the object_modelling package."""
