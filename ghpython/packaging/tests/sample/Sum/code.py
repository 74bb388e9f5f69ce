"""Adds numbers: a component for the tests of the packaging."""
Total = sum(Numbers or [])
