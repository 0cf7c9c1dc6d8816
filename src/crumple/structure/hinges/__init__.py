"""Where hinges are and what each can carry."""
