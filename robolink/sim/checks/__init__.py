"""What is wrong with a description that types cannot say, each problem with its place."""
