"""Mathematics that several packages use."""
