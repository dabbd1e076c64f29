"""Commands that run launch files: `launch`, `simulate`, and the control of launchers in other shells."""
