"""What scripts/figures draws with."""
