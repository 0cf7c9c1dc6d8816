"""The scene: what a viewer draws of one or more results, as data of limited size."""
